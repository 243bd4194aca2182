# The job of one cell, WHEEL/METAL/F_MAX/SHARE: its wheel, its forces, and the volume that they remove.
$all[0] as $all | ($cell | split("/")) as [$wheel, $metal, $max_force, $share] | $all.wheels[$wheel] as $w |
25.4 as $inch | 4.4482216152605 as $lbf |
(2 * 3.141592653589793 * $w.radius * $inch * $w.rpm / 60) as $v |
# mm³/(N s): forces in N times v in mm/s are N mm/s, u in J/mm³ is 1000 N mm/mm³
($machine[0].spindle.tangential * $v / (1000 * $all.specific_energy[$metal])) as $c |
.tolerance = $all.tolerance |
.wheel = {radius: $w.radius, width: $w.width, min_radius: (0.75 * $w.radius)} |
.feed.step_over = 0.8 * $w.width |
.force.max = ($max_force | tonumber) | .force.min = .force.max * ($share | tonumber) | .force.down = (.force.min + .force.max) / 2 |
.removal.coefficient = $c * $lbf / ($inch * $inch * $inch)
