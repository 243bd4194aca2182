# Touches whose noise the job overstates tenfold, or does not know. Reference: the generating noise, 0.001 in: the estimate from 16
# touches less the 4 parameters of a sphere is within 0.5 to 1.7 of it in 99.8 % of all cases (chi-squared, 12 degrees of freedom).
source "$HERE/points.bash"
job freeform | sed 's/1e-4/0.02576/' >coarse.json
job freeform | sed 's/1e-4/0.0002576/' >fine.json
heights '7 + sqrt(16 - x ^ 2 - y ^ 2)' 16 1 |
    awk 'BEGIN { srand(5) } { for (n = i = 0; i < 12; ++i) n += rand(); printf "%s %s %.9f\n", $1, $2, $3 + 0.001 * (n - 6) }' |
    touches >touches.pcd
for job in coarse fine; do
    fettle-fit --noise estimate --method sphere $job.json touches.pcd --report $job-report.json -o $job-surface.json
    jq -e '.touch_freedom == 12 and .goodness == null and .touch_sigma > 0.0005 and .touch_sigma < 0.0017' $job-report.json
    fettle-margin $job.json $job-surface.json >$job-margin.json
done
fettle-diff --tol 1e-9 coarse-surface.json fine-surface.json
fettle-diff --tol 1e-9 coarse-margin.json fine-margin.json
# Student's t at work: a known sigma of the same size takes a smaller shift.
jq 'del(.fit.touch_freedom)' coarse-surface.json | fettle-margin coarse.json >known.json
jq -n -e --slurpfile a coarse-margin.json --slurpfile b known.json '$a[0].shift > 1.02 * $b[0].shift'
"$HERE/../refuses" 'too few to estimate the noise' fettle-fit --noise estimate --method griddata coarse.json touches.pcd
