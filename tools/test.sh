#!/usr/bin/env bash
# Installs what is missing, builds everything and runs all tests. Ends with the line `N passed, M failed`; exit 0 when M is 0.
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

install_packages "${build_packages[@]}" "${test_packages[@]}"
build_all -DPLUMB_TESTS=ON -DPLUMB_BENCHMARKS=ON

cd "$build"
report="$build/tests.xml"
rm -f "$report"
ctest --output-on-failure -j "$(nproc)" --timeout 900 --output-junit "$report" "$@" >"$build/tests.log" 2>&1 || true
[ -s "$report" ] || { tail -n 40 "$build/tests.log"; echo "ctest did not run" >&2; exit 1; }

# Totals from the report; tests that were skipped say why in their own line.
python3 - "$report" <<'PYTHON'
import sys
import xml.etree.ElementTree as ET
suite = ET.parse(sys.argv[1]).getroot()
passed = failed = 0
skipped = {}
for case in suite.iter("testcase"):
    text = "".join(case.itertext())
    if case.get("status") == "run" and case.find("failure") is None:
        passed += 1
    elif case.find("skipped") is not None or case.get("status") in ("notrun", "disabled"):
        why = next((line.strip() for line in text.splitlines() if "skipped:" in line), "no reason given")
        skipped.setdefault(why, []).append(case.get("name"))
    else:
        failed += 1
        print("FAILED", case.get("name"))
        print("\n".join("    " + line for line in text.strip().splitlines()[-40:]))
for why, names in skipped.items():
    print(f"{len(names)} tests skipped: {why}")
total = f"{passed} passed, {failed} failed"
if skipped:
    total += f", {sum(map(len, skipped.values()))} skipped"
print(total)
sys.exit(1 if failed or not passed else 0)
PYTHON
