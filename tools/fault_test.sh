#!/usr/bin/env bash
# Fails every file-system call of small runs once in each way (some 20,000 times) and checks after each that nothing is lost and nothing stays behind.
#   bash tools/fault_test.sh [--scenario NAME]... [--stride N] [--jobs N]      builds first; exit 0 when every promise was kept
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

install_packages "${build_packages[@]}" "${test_packages[@]}"
build_all -DPLUMB_TESTS=ON
export PLUMB="$build/bin/plumb" PLUMB_BUILD="$build" PLUMB_SOURCE="$root" PYTHONDONTWRITEBYTECODE=1
exec /usr/bin/python3 "$root/tests/faults/faults_test.py" "$@" "$build/lib/libplumb_faults.so"
