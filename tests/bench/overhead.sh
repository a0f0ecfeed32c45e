#!/bin/bash
# overhead.sh BUILD FOLDER : milliseconds an item of a step that does nothing, in process, in workers and, where sbatch is there, over Slurm. FOLDER must be
# new: on ext4, files that were removed a moment ago make new ones ten times slower. Needs a build with tests.
set -euo pipefail
build="${1:?build folder}" folder="${2:?new folder}" here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
mkdir "$folder"
printf 'cpus: 1\nchunk: 500\nsubmit_above: 0 s\npoll: 0.3 s\n' >"$folder/profile.yaml"

# measured NAME OPTION...: the time of the step, of 2,000 items
measured() {
  local name="$1"
  shift
  "$build/bin/plumb" --plugin-path "$build/tests/end_to_end/modules" run "$here/overhead.yaml" --events "$folder/$name.jsonl" "$@" -o "$folder/$name.out" >/dev/null 2>&1
  sed -n 's/.*"event":"step_ends".*"duration":\([^,]*\),"step":"nothing".*/\1/p' "$folder/$name.jsonl" |
    awk -v name="$name" '{printf "%-28s %.3f ms an item\n", name, $1 / 2}'
}

measured "without_cache" --no-cache
for k in 1 2 3; do measured "in_process_$k" --cache-dir "$folder/store_$k"; done
measured "in_process_found_again" --cache-dir "$folder/store_3"
for k in 1 2 3; do measured "workers_$k" --cache-dir "$folder/store_w$k" --executor process; done
if command -v sbatch >/dev/null; then measured "slurm_4_chunks" --cache-dir "$folder/store_s" --executor slurm --executor-profile "$folder/profile.yaml"; fi
