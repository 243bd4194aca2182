# The machine with the spindle of a wheel.
$all[0] as $all | .spindle += $all.spindle | .spindle.rpm = $all.wheels[$wheel].rpm
