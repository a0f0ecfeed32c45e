#!/usr/bin/python3
"""Draws a sequence from above before and after: picture.py SEQUENCE TRAJECTORY.tum OUT.png (needs python3-numpy, python3-matplotlib).

Every frame's points, moved by the odometry on the left and by TRAJECTORY on the right; height is grey, the path red."""
import pathlib
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np


def read_pcd(file):
    data = file.read_bytes()
    at = data.index(b"DATA binary\n") + len(b"DATA binary\n")
    header = dict(line.split(" ", 1) for line in data[:at].decode().splitlines() if not line.startswith("#"))
    fields = len(header["FIELDS"].split())
    return np.frombuffer(data, "<f4", int(header["POINTS"]) * fields, at).reshape(-1, fields)[:, :3]


def rotation(q):
    x, y, z, w = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def main(sequence, trajectory, out):
    sequence = pathlib.Path(sequence)
    frames = sorted((sequence / "frames").glob("*.pcd"))
    figure, axes = plt.subplots(1, 2, figsize=(12, 6), sharex=True, sharey=True)
    for axis, file, title in zip(axes, (sequence / "odometry.tum", trajectory), ("before", "after")):
        poses = np.loadtxt(file)
        points = []
        for frame, pose in list(zip(frames, poses))[::2]:
            p = read_pcd(frame)[::9]
            p = p[(np.linalg.norm(p, axis=1) < 50)]
            points.append(p @ rotation(pose[4:8]).T + pose[1:4])
        points = np.concatenate(points)
        points = points[points[:, 2] > np.median(poses[:, 3]) - 1]  # without the ground
        axis.scatter(points[:, 0], points[:, 1], s=0.05, c="k", alpha=0.25, linewidths=0)
        axis.plot(poses[:, 1], poses[:, 2], "r-", linewidth=1)
        axis.set_title(title)
        axis.set_aspect("equal")
        axis.axis("off")
    figure.tight_layout()
    figure.savefig(out, dpi=80)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
