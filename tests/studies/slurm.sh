# A study on a real Slurm gives the same bytes as without; killed workers and lost nodes cost their own cells only.
for program in slurmctld slurmd munged srun; do
    PATH=$PATH:/usr/sbin command -v $program >/dev/null ||
        { echo "$program is not installed (apt-get install slurmctld slurmd slurm-client munge)"; exit 77; }
done
"$HERE/../../pipelines/cluster/demonstrate" "$(dirname "$(dirname "$(command -v factorial)")")"
