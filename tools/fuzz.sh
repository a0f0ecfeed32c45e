#!/usr/bin/env bash
# Gives every reader of files and messages (tests/fuzz) made-up inputs for MINUTES each, two readers at a time, under AddressSanitizer and
# UndefinedBehaviorSanitizer, within a second and 512 MiB an input.
#   bash tools/fuzz.sh MINUTES [READER...]
# Tells the executions of each; exit 1 when something was found. Inputs that led further stay in BUILD/fuzz/corpus for the next time, findings in
# BUILD/fuzz/findings.
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

minutes="${1:?usage: tools/fuzz.sh MINUTES [READER...]}"
shift
build="$build/fuzz"
build_targets=(fuzz)
install_packages "${build_packages[@]}" "${fuzz_packages[@]}"
build_all -DPLUMB_FUZZ=ON -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++
readers=("$@")
if [ ${#readers[@]} -eq 0 ]; then for seeds in "$root"/tests/fuzz/seeds/*/; do readers+=("$(basename "$seeds")"); done; fi

# The quarantine of freed memory counts to the bound.
export ASAN_OPTIONS=quarantine_size_mb=16 UBSAN_OPTIONS=print_stacktrace=1
bounds=(-timeout=1 -rss_limit_mb=512 -malloc_limit_mb=512 -max_len=65536)
shared_memory=/dev/shm
[ -w $shared_memory ] || shared_memory="$build"
TMPDIR="$(mktemp -d -p "$shared_memory" plumb_fuzz.XXXXXX)"
export TMPDIR
trap 'rm -rf "$TMPDIR"' EXIT
mkdir -p "$build/logs"

# Whether an input is found again when it is read alone: one that was only slow beside others is not.
repeats() { ! "$build/bin/fuzz_$1" "${bounds[@]}" "$2" >>"$build/logs/$1.txt" 2>&1; }

# fuzz READER: until its time is over or something is found.
fuzz() {
  local reader="$1" executions=0 found="" count left end=$((SECONDS + minutes * 60))
  local known="$root/tests/fuzz/findings/$1" dictionary="$root/tests/fuzz/dictionaries/$1"
  local corpus="$build/corpus/$reader" findings="$build/findings/$reader" options=()
  mkdir -p "$corpus" "$findings"
  rm -f "$findings"/*
  : >"$build/logs/$reader.txt"
  if [ -f "$dictionary" ]; then options+=("-dict=$dictionary"); fi
  while left=$((end - SECONDS)) && [ -z "$found" ] && [ $left -gt 0 ]; do
    "$build/bin/fuzz_$reader" "${bounds[@]}" "${options[@]}" -max_total_time=$left -print_final_stats=1 \
      -artifact_prefix="$findings/" "$corpus" "$root/tests/fuzz/seeds/$reader" $([ -d "$known" ] && echo "$known") >"$build/logs/$reader.last" 2>&1 || true
    count="$(sed -n 's/^stat::number_of_executed_units: *//p' "$build/logs/$reader.last")"
    [ -n "$count" ] || found=" its own end"
    executions=$((executions + ${count:-0}))
    cat "$build/logs/$reader.last" >>"$build/logs/$reader.txt"
    for input in "$findings"/*; do
      case "$input" in *'*' | */slow-unit-*) continue ;; esac
      if repeats "$reader" "$input"; then found="$found $input"; else rm "$input"; fi
    done
  done
  printf '%-18s %10d executions%s\n' "$reader" "$executions" "${found:+   FOUND$found, see $build/logs/$reader.txt}" | tee "$build/logs/$reader.told"
}

for reader in "${readers[@]}"; do
  [ -x "$build/bin/fuzz_$reader" ] || { echo "there is no reader '$reader'; the readers are: $(ls "$root/tests/fuzz/seeds" | tr '\n' ' ')" >&2; exit 1; }
done
for reader in "${readers[@]}"; do
  while [ "$(jobs -rp | wc -l)" -ge 2 ]; do sleep 1; done
  fuzz "$reader" &
done
wait
told=()
for reader in "${readers[@]}"; do told+=("$build/logs/$reader.told"); done
cat "${told[@]}" | awk '{sum += $2; found += /FOUND/} 
  END {printf "%d executions of %d readers, %d with findings\n", sum, NR, found; exit found > 0}'
