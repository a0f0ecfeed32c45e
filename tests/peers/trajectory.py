#!/usr/bin/env python3
"""What a peer estimated, as a trajectory with a pose for every scan under the log's own stamp.

usage: trajectory.py odometry    SCANS.txt                 the wheels
       trajectory.py icp-slam    SCANS.txt FOLDER          the pose after each scan
       trajectory.py rbpf-online SCANS.txt FOLDER          the particles' mean after each scan
       trajectory.py rbpf-path   SCANS.txt FOLDER SAID     the path of the best particle at the end; SAID: the program's output
Prints TUM lines. SCANS.txt is carmen_to_rawlog's: stamp x y theta.
"""
import math
import sys


def rows(file):
    with open(file) as lines:
        return [line.split() for line in lines if line.strip() and not line.startswith("%")]


def inverse_times(a, b):
    """The motion from a to b, in a's coordinates."""
    dx, dy, c, s = b[0] - a[0], b[1] - a[1], math.cos(a[2]), math.sin(a[2])
    return c * dx + s * dy, c * dy - s * dx, b[2] - a[2]


def times(a, b):
    c, s = math.cos(a[2]), math.sin(a[2])
    return a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], a[2] + b[2]


def updated(said):
    """For every scan, whether the filter took a step with it: it says its new pose then, before it counts the scan."""
    flags, stepped = [], False
    with open(said, errors="replace") as lines:
        for line in lines:
            if "New pose=" in line:
                stepped = True
            elif "- STEP " in line:
                flags.append(stepped)
                stepped = False
    return flags


def best_path(folder, said, wheels):
    """The path has the poses of the steps only; between them the wheels lead on from the last one."""
    path = [tuple(map(float, row)) for row in rows(folder + "/most_likely_path.txt")]
    flags = updated(said)
    if len(path) == sum(flags) + 1:  # begins with the pose before the first step
        path = path[1:]
    if len(path) != sum(flags) or len(flags) != len(wheels):
        sys.exit(f"{folder}: {len(path)} poses for {sum(flags)} steps, {len(flags)} of {len(wheels)} scans")
    poses, step, last = [], -1, wheels[0]
    for wheel, flag in zip(wheels, flags):
        if flag:
            step, last = step + 1, wheel
        poses.append(times(path[max(step, 0)], inverse_times(last, wheel)))
    return poses


def main(kind, scans, folder="", said=""):
    scans = rows(scans)
    wheels = [tuple(map(float, row[1:4])) for row in scans]
    if kind == "odometry":
        poses = wheels
    elif kind == "icp-slam":
        poses = [tuple(map(float, row[1:4])) for row in rows(folder + "/log_estimated_path.txt")]
    elif kind == "rbpf-online":
        poses = [(float(r[1]), float(r[2]), float(r[4])) for r in rows(folder + "/log_estimated_path.txt")]
    elif kind == "rbpf-path":
        poses = best_path(folder, said, wheels)
    else:
        sys.exit(__doc__)
    if len(poses) != len(scans):
        sys.exit(f"{folder}: {len(poses)} poses for {len(scans)} scans; did the program stop?")
    for (stamp, *_), (x, y, yaw) in zip(scans, poses):
        print(f"{stamp} {x:.9f} {y:.9f} 0 0 0 {math.sin(yaw / 2):.9f} {math.cos(yaw / 2):.9f}")


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
