#!/usr/bin/env bash
# Installs what is missing, builds, simulates a loop through a city with metres of drift, straightens it and shows the result.
#   bash tools/demo.sh [FOLDER]      results go to FOLDER, by default build/demo
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

install_packages "${build_packages[@]}"
# A folder that was built otherwise is carried on with.
unity=()
if [ ! -f "$build/CMakeCache.txt" ]; then unity=(-DPLUMB_UNITY=ON); fi
build_all "${unity[@]}" -DPLUMB_TESTS=OFF -DPLUMB_BENCHMARKS=OFF
plumb="$build/bin/plumb"
folder="$(realpath -m "${1:-$build/demo}")"
mkdir -p "$folder"

echo
echo "1. A sequence: 200 scans of 32 x 1024 rays round a block of streets, and an odometry that drifts by metres"
"$plumb" simulate city_loop --frames 200 --length 400m --lines 32 --drift 8 -o "$folder/street"

echo
echo "2. The recommended pipeline"
"$plumb" run "$root/pipelines/plumb.yaml" \
  --set input="$folder/street" --set truth="$folder/street/truth.tum" --no-cache -o "$folder/straight"

echo
echo "3. Against the truth"
"$plumb" evaluate "$folder/street" "$folder/straight/trajectory.tum" --clouds

echo
echo "The drifted sequence is in $folder/street, the straight one in $folder/straight:"
echo "  trajectory.tum  every frame's pose     map.ply  the cloud (CloudCompare, MeshLab, PCL open it)"
echo "  metrics.json    what became of each edge     uncertainty.csv  how well each position is known"
