#!/bin/bash
# A data set as a job array of Slurm whose tasks are containers. In the folder with the scene, which all
# nodes have under the same name:
#
#     container_array.sh TASKS SET SCENE [options of uwvdb dataset]
#
# submits TASKS shards, and after them a job that merges and checks. What Slurm is to be asked for besides stands
# in its own variables, such as SBATCH_PARTITION, SBATCH_ACCOUNT and SBATCH_TIMELIMIT. Of tasks that were killed the
# same command makes what is missing. UWVDB_CONTAINER is how a container is run, with the folder at /work.
#SBATCH --job-name=uwvdb
#SBATCH --requeue
#SBATCH --nodes=1 --ntasks=1
#SBATCH --cpus-per-task=2
#SBATCH --mem=2G
set -euo pipefail
if (($# < 3)); then
    echo "usage: $0 TASKS SET SCENE [options of uwvdb dataset]" >&2
    exit 2
fi
tasks=$1 set=$2
read -ra container <<<"${UWVDB_CONTAINER:-podman run --rm --read-only --userns=keep-id -v $PWD:/work uwvdb}"

if [[ -n ${SLURM_ARRAY_TASK_ID-} ]]; then
    exec "${container[@]}" dataset "${@:3}" -o "$set" --quiet --threads "$SLURM_CPUS_PER_TASK" \
        --shard "$SLURM_ARRAY_TASK_ID/$tasks"
elif [[ -n ${UWVDB_MERGE-} ]]; then
    "${container[@]}" dataset --merge "$set" --quiet
    cd "$set" && exec sha256sum --check --quiet SHA256SUMS
fi
mkdir -p "$set-logs"
array=$(sbatch --parsable --array="1-$tasks" --output="$set-logs/%a.log" "$0" "$@")
UWVDB_MERGE=1 sbatch --dependency="afterok:${array%%;*}" --kill-on-invalid-dep=yes --output="$set-logs/merge.log" \
    "$0" "$@"
