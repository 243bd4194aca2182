# Same input, same bytes, for any number of threads.
source "$HERE/points.bash"
job freeform >job.json
heights '0.2 * sin(3 * x) + 0.3 * y ^ 2' 40 1 | touches >touches.pcd
fettle-fit job.json touches.pcd --threads 1 >one.json
fettle-fit job.json touches.pcd --threads 2 | cmp one.json
fettle-mesh one.json --step 0.02 --within job.json --sigma --threads 1 >one.pcd
fettle-mesh one.json --step 0.02 --within job.json --sigma --threads 2 | cmp one.pcd
