#!/usr/bin/env bash
# icp-slam and rbpf-slam of MRPT (Debian: mrpt-apps) on 2-D logs, judged by the relations of Kuemmerle et al. 2009 or by a
# simulated truth, with times. A table at the end; trajectories, logs of the programs and maps stay in OUTPUT.
#
#   bash tests/peers/run.sh [OPTIONS] [LOG RELATIONS | SIMULATED_FOLDER]...      default: aces and intel of the shared data
#
#   --install       install mrpt-apps and libmrpt-obs-dev first (apt-get)
#   --first N       only the first N scans
#   --only NAMES    of odometry,icp-slam,rbpf-slam,plumb
#   --plumb FILE    also run pipelines/zhang2023.yaml with this plumb
#   --judge FILE    the judge, by default ../shared/tools/judge.py (needs numpy and scipy)
#   --data DIR      default ../shared/data/laser2d
#   --output DIR    default build/peers
#   --beside        leave icp-slam.tum and rbpf-slam.tum in a SIMULATED_FOLDER too, for plumb compare --variant rbpf-slam=pipelines/judge2d.yaml
set -euo pipefail

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
root="$(dirname "$(dirname "$here")")"
judge="$root/../shared/tools/judge.py"
data="$root/../shared/data/laser2d"
output="$root/build/peers"
first="" plumb="" only="odometry,icp-slam,rbpf-slam,plumb" install="" beside=""
inputs=()

refuse() {
  echo "run.sh: $*" >&2
  exit 2
}

while [[ $# -gt 0 ]]; do
  case "$1" in
    --install) install=yes; shift; continue ;;
    --beside) beside=yes; shift; continue ;;
    --first | --only | --plumb | --judge | --data | --output)
      [[ $# -ge 2 ]] || refuse "$1 takes a value"
      printf -v "${1#--}" '%s' "$2"; shift 2 ;;
    -h | --help) sed -n '2,15s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 0 ;;
    -*) refuse "unknown option $1; --help lists them" ;;
    *) inputs+=("$(realpath -m "$1")"); shift ;;
  esac
done
[[ ${#inputs[@]} -gt 0 ]] || inputs=("$data/aces.clf.bz2" "$data/aces.relations" "$data/intel.clf.bz2" "$data/intel.relations")
[[ -z "$first" || "$first" =~ ^[1-9][0-9]*$ ]] || refuse "--first takes a number of scans, not '$first'"
[[ -f "$judge" ]] || refuse "no judge at $judge; name one with --judge"
[[ -z "$plumb" || -x "$plumb" ]] || refuse "$plumb is no program; name a built plumb with --plumb"
judge="$(realpath "$judge")"  # everything runs in folders of its own
[[ -z "$plumb" ]] || plumb="$(realpath "$plumb")"
python=python3
python3 -c 'import numpy, scipy' 2>/dev/null || python=/usr/bin/python3

packages=(mrpt-apps libmrpt-obs-dev)
if [[ -n "$install" ]]; then
  sudo=""; [[ $(id -u) -eq 0 ]] || sudo=sudo
  $sudo apt-get install -y --no-install-recommends "${packages[@]}" >/dev/null
fi
for program in icp-slam rbpf-slam; do
  command -v "$program" >/dev/null || refuse "$program is not installed; add --install, or: apt-get install ${packages[*]}"
done

output="$(realpath -m "$output")"
mkdir -p "$output"
cmake -S "$here" -B "$output/build" >"$output/build.log" 2>&1 && cmake --build "$output/build" >>"$output/build.log" 2>&1 ||
  refuse "the converter does not build; see $output/build.log, or add --install"

plain() {  # the log, unpacked
  case "$1" in
    *.bz2) bzip2 -dc "$1" ;;
    *.gz) gzip -dc "$1" ;;
    *) cat "$1" ;;
  esac
}

table="$output/table.txt"
printf '%-12s %-22s %8s %8s  %s\n' log method 'wall [s]' 'CPU [s]' error | tee "$table"

# report LOG METHOD TIMES TRAJECTORY TRUTH: a row; TIMES is "real user system" or "-".
report() {
  local real=- cpu=- said
  [[ "$3" == - ]] || read -r real cpu < <(awk '{printf "%.1f %.1f\n", $1, $2 + $3}' <<<"$3")
  if [[ -d "$5" ]]; then said="$("$python" "$judge" "$5" "$4" | sed -n 's/^after *//p')"
  else said="$("$python" "$judge" --relations "$5" "$4")"; fi
  printf '%-12s %-22s %8s %8s  %s\n' "$1" "$2" "$real" "$cpu" "$said" | tee -a "$table"
}

# timed FILE COMMAND...: runs it; its output goes to FILE, the times are printed.
timed() {
  local said="$1" TIMEFORMAT='%R %U %S'; shift
  { time nice "$@" >"$said" 2>&1 </dev/null || echo "failed: $*, see $said" >&3; } 3>&2 2>&1
}

wanted() { [[ ",$only," == *",$1,"* ]]; }

set -- "${inputs[@]}"
while [[ $# -gt 0 ]]; do
  log="$1" truth=""; shift
  if [[ -d "$log" ]]; then truth="$log"; name="$(basename "$log")"; log="$log/log.clf"
  else
    [[ $# -ge 1 ]] || refuse "$log wants its relations behind it"
    truth="$1" name="$(basename "${log%%.clf*}")"; shift
  fi
  [[ -f "$log" && -e "$truth" ]] || refuse "$log or $truth is missing"
  work="$output/$name"
  mkdir -p "$work"; cd "$work"
  # shellcheck disable=SC2086
  plain "$log" 2>/dev/null | { "$output/build/carmen_to_rawlog" - log.rawlog scans.txt $first; cat >/dev/null; }
  if wanted odometry; then
    "$here/trajectory.py" odometry scans.txt >odometry.tum
    report "$name" odometry - odometry.tum "$truth"
  fi
  if wanted icp-slam; then
    times="$(timed icp-slam.txt icp-slam "$here/icp-slam.ini" log.rawlog)"
    "$here/trajectory.py" icp-slam scans.txt icp-slam >icp-slam.tum
    report "$name" icp-slam "$times" icp-slam.tum "$truth"
    [[ -z "$beside" || ! -d "$truth" ]] || cp icp-slam.tum "$truth/"
  fi
  if wanted rbpf-slam; then
    times="$(timed rbpf-slam.txt rbpf-slam "$here/rbpf-slam.ini" log.rawlog)"
    "$here/trajectory.py" rbpf-path scans.txt rbpf-slam rbpf-slam.txt >rbpf-slam.tum
    "$here/trajectory.py" rbpf-online scans.txt rbpf-slam >rbpf-slam-online.tum
    report "$name" "rbpf-slam, best path" "$times" rbpf-slam.tum "$truth"
    [[ -z "$beside" || ! -d "$truth" ]] || cp rbpf-slam.tum "$truth/"
    report "$name" "rbpf-slam, online" "$times" rbpf-slam-online.tum "$truth"
  fi
  if [[ -n "$plumb" ]] && wanted plumb; then
    times="$(timed plumb.txt "$plumb" run "$root/pipelines/zhang2023.yaml" --set input="$log" --no-cache -o plumb)"
    report "$name" "plumb zhang2023" "$times" plumb/trajectory.tum "$truth"
  fi
done
echo "The table is in $table"
