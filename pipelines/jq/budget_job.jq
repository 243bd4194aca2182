# The job of a part on the laboratory prototype; without the tool's error a wheel so narrow that it leaves no steps.
$all[0] as $all | $all.job as $job |
.force = $job.force | .wheel = $job.wheel | .feed.step_over = $job.step_over | .removal.coefficient = $job.removal |
if $tool == "" then .wheel.width = $all.no_tool.width | .feed.step_over = $all.no_tool.step_over else . end
