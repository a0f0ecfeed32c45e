"""IA-ICP against standard ICP on the same pieces of the path: the paper's claim (50.22 % fewer iterations), and how much the early end costs."""
import json

import numpy as np

from judge import Trajectory
from plumb_test import plumb, real_file

PIPELINE = """plumb: 1
name: laid
parameters:
  input: {type: path}
steps:
  log:     {use: source.carmen,       with: {path: $input}}
  each:    {CUT}
  raw:     {use: segment.merge,       from: {frames: log.frames, ranges: each.ranges}}
  scans:   {use: filter.voxel_grid,   from: raw, with: {voxel_size: 0.05 m}}
  next:    {use: gate.distance,       from: scans}
  matched: {use: register.STEP,       from: {edges: next.edges, targets: scans, sources: scans, poses: each.poses}}
  chained: {use: apply.chain,         from: {poses: each.poses, registrations: matched}}
  graph:   {use: write.graph,         from: {poses: chained.poses, constraints: chained.constraints}}
  metrics: {use: write.metrics,       from: {metrics: {chained: chained.metrics}}}
"""
BY_DISTANCE = "use: segment.by_distance, from: log.trajectory, with: {length: 0.2 m, max_rotation: 5 deg}"
BY_COUNT = "use: segment.by_count, from: log.trajectory, with: {frames: 5}"  # one second of a simulated drive


def laid(folder, step, log, cut):
    """Numbers of the chain, and the registrations as rows i, j, x, y [m]."""
    (folder / f"{step}.yaml").write_text(PIPELINE.replace("STEP", step).replace("CUT", cut))
    plumb("run", folder / f"{step}.yaml", "--set", f"input={log}", "-o", folder / step)
    stages = json.loads((folder / step / "metrics.json").read_text())["stages"]
    numbers = next(stage["numbers"] for stage in stages if stage["stage"] == "chained")
    edges = [line.split() for line in (folder / step / "graph.g2o").read_text().splitlines() if line.startswith("EDGE_SE2")]
    assert len(edges) > 100
    return {name: number["value"] for name, number in numbers.items()}, np.array([[float(word) for word in edge[1:5]] for edge in edges])


def both(folder, log, cut):
    usual, usual_edges = laid(folder, "icp", log, cut)
    adaptive, adaptive_edges = laid(folder, "ia_icp", log, cut)
    fewer = 100 * (1 - adaptive["iterations"] / usual["iterations"])
    print(f"{log}: iterations {usual['iterations']:.2f} and {adaptive['iterations']:.2f}, {fewer:.1f} % fewer; "
          f"median MAE {1000 * usual['mae_median']:.1f} and {1000 * adaptive['mae_median']:.1f} mm")
    assert fewer >= 50 and adaptive["mae_median"] <= usual["mae_median"] + 0.005
    return usual_edges, adaptive_edges


def simulated(folder, scene):
    plumb("simulate", scene, "-o", folder / scene)
    truth = Trajectory.read(folder / scene / "truth.tum")

    def off(edges):
        """Median distance [m] of the places found from the true ones; a segment's coordinates are those of its middle frame."""
        whole = edges[:-1]  # the last segment may be shorter
        return np.median([np.linalg.norm(truth.motion(int(5 * i + 2), int(5 * j + 2))[1][:2] - place) for i, j, *place in whole])

    usual, adaptive = (off(edges) for edges in both(folder, folder / scene / "log.clf", BY_COUNT))
    print(f"median distance from the truth {1000 * usual:.1f} and {1000 * adaptive:.1f} mm")
    assert adaptive <= usual + 0.005


def test_halves_the_iterations_in_a_corridor(folder):
    simulated(folder, "corridor")


def test_halves_the_iterations_in_rooms(folder):
    simulated(folder, "rooms")


def test_halves_the_iterations_on_aces(folder):
    both(folder, real_file("laser2d/aces.clf.bz2"), BY_DISTANCE)


def test_halves_the_iterations_on_intel(folder):
    both(folder, real_file("laser2d/intel.clf.bz2"), BY_DISTANCE)
