# The surface of a job is a plane where the metal around is one, or bends so little that a plane is expected to leave no more than a free-form
# surface, which leaves about the tolerance, and to cut no deeper than the tolerance. It is touched as often as its tolerance needs.
# Reference: the sheet's own bend, z = c x², under a bump of 2 mm and 4 mm radius: about 8 c on the mean and 16 c at the
# most stand out of a plane through its foot, which is raised by half of the probe's accuracy, half of the tolerance. With
# c = 0.004 that leaves .01 mm at a tolerance of .1, .026 at .025. Noise of 0.02 mm by a linear congruential generator.
sheet() { # C
    LC_ALL=C awk -v c="$1" 'function uniform() { state = (state * 16807) % 2147483647; return state / 2147483647 }
        BEGIN { state = 1
            for (y = -25; y <= 25; y += 0.4) for (x = -25; x <= 25; x += 0.4) {
                noise = 0; for (k = 0; k < 12; ++k) noise += uniform()
                r = (x * x + y * y) / 16
                printf "%.3f %.3f %.4f\n", x, y, c * x * x + 0.02 * (noise - 6) + (r < 1 ? 2 * (1 - r) : 0) } }'
}
surface() { # TOLERANCE SHEET.xyz
    jq ".tolerance = $1 | .probe.accuracy = $1 / 2" "$SAMPLES/jobs/hammer.json" > template.json
    fettle-find "$2" --jobs "jobs$1" --template template.json --report found.json -o found.pcd || [ $? = 1 ]
    jq -r .surface.type "jobs$1/$(jq '.anomalies | max_by(.height) | .anomaly' found.json).json"
}
sheet 0 > plane.xyz
sheet 0.004 > bent.xyz
sheet 0.02 > curved.xyz
[ "$(surface 0.1 plane.xyz)" = plane ]
[ "$(surface 0.1 bent.xyz)" = plane ]
[ "$(surface 0.025 bent.xyz)" = freeform ]
[ "$(surface 0.1 curved.xyz)" = freeform ]
# n touches, off by the scan's noise and by a probe of half the tolerance, move the plane's rim by √(3/n) of that: to keep it at a tenth of the
# tolerance .1 takes 300 (.028 / .1)² = 24, of the tolerance 1 300 (.195 / 1)² = 12; sides have equal pieces, so some more.
corners() { jq '.anomaly | length' "jobs$1/1.json"; }
[ "$(surface 0.1 plane.xyz) $(surface 1 plane.xyz)" = 'plane plane' ]
[ "$(corners 0.1)" -ge 22 ]
[ "$(corners 0.1)" -le 29 ]
[ "$(corners 1)" -ge 11 ]
[ "$(corners 1)" -le 16 ]
