#!/usr/bin/env bash
# Builds with ThreadSanitizer and runs the tests of engine and store and two whole runs, in space and in the plane. Exit 1 when it reports anything.
#   bash tools/tsan.sh
# Worker processes are left out: they bound their memory, into which the sanitizer's own does not fit. What is reported stands in
# BUILD/tsan/report.PID; what is let pass, and why, in tools/tsan.supp.
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

build="$build/tsan"
build_targets=(test_engine test_store plumb_command plumb_modules)
install_packages "${build_packages[@]}" "${test_packages[@]}"
# Without the steps by PCL: what that brings along (OpenNI) unlocks a mutex that it does not hold, whenever it is loaded.
build_all -DPLUMB_SANITIZE=thread -DPLUMB_TESTS=ON -DPLUMB_BENCHMARKS=OFF -DCMAKE_DISABLE_FIND_PACKAGE_PCL=ON

scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
rm -f "$build"/report.*
export TSAN_OPTIONS="suppressions=$root/tools/tsan.supp exitcode=66 log_path=$build/report"
plumb="$build/bin/plumb"
status=0

# told NAME COMMAND...: runs it and says how it went.
told() {
  local name="$1"
  shift
  if "$@" >"$build/$name.txt" 2>&1; then echo "$name: passed"; else status=1; echo "$name: FAILED, see $build/$name.txt"; fi
}

told test_engine "$build/bin/test_engine" --gtest_filter=-Memory.SeesWhatAStepHeldAndLetGo  # what the sanitizer holds would count
told test_store "$build/bin/test_store"
told simulate_space "$plumb" simulate out_and_back --frames 24 --length 60m --lines 16 --columns 256 --drift 1 -o "$scratch/space"
told simulate_plane "$plumb" simulate rooms --length 12m --speed 0.5m/s --rate 2Hz --columns 181 -o "$scratch/plane"
options=(--threads 4 --cache-dir "$scratch/store")
told run_in_space "$plumb" run "$root/pipelines/plumb.yaml" --set input="$scratch/space" "${options[@]}" -o "$scratch/straight"
told run_in_plane "$plumb" run "$root/pipelines/zhang2023.yaml" --set input="$scratch/plane/log.clf" "${options[@]}" -o "$scratch/map"

reports=$(cat "$build"/report.* 2>/dev/null | grep -c '^WARNING: ThreadSanitizer' || true)
echo "$reports reports of ThreadSanitizer"
[ "$reports" -eq 0 ] && [ $status -eq 0 ]
