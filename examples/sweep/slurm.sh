#!/usr/bin/env bash
# A study as an array of jobs, and a job that joins what they found:
#
#   array=$(sbatch --parsable --array=1-8 slurm.sh study.toml)
#   sbatch --dependency=afterany:$array slurm.sh study.toml merge
#
# A task that is killed keeps its finished cases: submit the same array again.
#SBATCH --job-name=tabor
#SBATCH --cpus-per-task=4
#SBATCH --mem-per-cpu=1G
#SBATCH --time=02:00:00
set -euo pipefail

study=$1
out=${study%.toml}
if [ "${2:-}" = merge ]; then
  exec tabor sweep "$study" --out "$out" --merge
fi
# Status 3: a case failed or did not converge. The table tells which; the task has done its work.
tabor sweep "$study" --out "$out" --only "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" \
  --jobs "$SLURM_CPUS_PER_TASK" --threads 1 --quiet || [ $? -eq 3 ]
