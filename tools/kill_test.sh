#!/usr/bin/env bash
# Ends runs, compares, workers and prunes at N random moments by random signals, and checks after each that nothing is lost and nothing stays behind.
#   bash tools/kill_test.sh N [--seed SEED]      builds first; exit 0 when every promise was kept
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

[ $# -gt 0 ] || { sed -n 2,3p "${BASH_SOURCE[0]}" | cut -c 3- >&2; exit 2; }
install_packages "${build_packages[@]}" python3
build_all
export PLUMB="$build/bin/plumb" PLUMB_BUILD="$build" PLUMB_SOURCE="$root" PYTHONDONTWRITEBYTECODE=1
exec /usr/bin/python3 "$root/tests/faults/kill_test.py" "$@"
