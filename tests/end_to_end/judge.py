"""A second way to judge a trajectory, from the definitions, with numpy and scipy alone.

ATE       distances of the positions after the one rigid motion (Kabsch 1976) that brings all estimated positions closest to the true ones
RPE       for each pose i and the first pose j at least 10 m of true path later: length and angle of E_ij^-1 applied to the true motion
ghosting  pairs of frames that truth puts within 6 m though more than 30 m of path (or a quarter of all) lies between: each point's
          distance to the other frame's nearest point, rms of those below the 80 % quantile; the median over pairs
"""
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation


class Trajectory:
    """Stamps [s] of shape (n,), rotations (n, 3, 3) and positions (n, 3) of world_T_frame."""

    def __init__(self, stamps, rotations, positions):
        self.stamps, self.rotations, self.positions = stamps, rotations, positions

    @staticmethod
    def read(file):
        rows = np.loadtxt(file, ndmin=2)
        return Trajectory(rows[:, 0], Rotation.from_quat(rows[:, 4:8]).as_matrix(), rows[:, 1:4])

    def __len__(self):
        return len(self.stamps)

    def at(self, where):
        return Trajectory(self.stamps[where], self.rotations[where], self.positions[where])

    def motion(self, i, j):
        """Rotation and translation of i_T_j."""
        return self.rotations[i].T @ self.rotations[j], self.rotations[i].T @ (self.positions[j] - self.positions[i])

    def path(self):
        return np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(self.positions, axis=0), axis=1))])


def paired(estimate, truth, tolerance=2e-3):
    nearest = np.array([np.argmin(abs(truth.stamps - stamp)) for stamp in estimate.stamps])
    close = abs(truth.stamps[nearest] - estimate.stamps) < tolerance
    return estimate.at(close), truth.at(nearest[close])


def absolute_error(estimate, truth):
    """Root mean square and greatest distance [m]."""
    a, b = estimate.positions - estimate.positions.mean(0), truth.positions - truth.positions.mean(0)
    rotation, _ = Rotation.align_vectors(b, a)
    distances = np.linalg.norm(rotation.apply(a) - b, axis=1)
    return float(np.sqrt(np.mean(distances**2))), float(distances.max())


def relative_error(estimate, truth, over=10.0):
    """Mean length [m] and angle [degree] of the error of the motion over so much true path."""
    path, lengths, angles = truth.path(), [], []
    for i in range(len(path)):
        later = np.flatnonzero(path >= path[i] + over)
        if not len(later):
            break
        true_r, true_t = truth.motion(i, later[0])
        r, t = estimate.motion(i, later[0])
        lengths.append(np.linalg.norm(true_r.T @ (t - true_t)))
        angles.append(np.degrees(Rotation.from_matrix(true_r.T @ r).magnitude()))
    return (float(np.mean(lengths)), float(np.mean(angles))) if lengths else (None, None)


def points_of(file):
    """x y z of a binary PCD file whose fields are all float32."""
    data = Path(file).read_bytes()
    header, points = data.split(b"DATA binary\n", 1)
    lines = dict(line.split(maxsplit=1) for line in header.decode().splitlines() if line and not line.startswith("#"))
    assert set(lines["TYPE"].split()) == {"F"} and set(lines["SIZE"].split()) == {"4"}, lines
    return np.frombuffer(points, "<f4").reshape(int(lines["POINTS"]), -1)[:, :3].astype(float)


def frames_of(sequence):
    listed = Path(sequence) / "frames.txt"
    if listed.exists():
        return [Path(sequence) / line.strip() for line in listed.read_text().splitlines() if line.strip()]
    return sorted((Path(sequence) / "frames").iterdir())


def revisits(truth):
    path, pairs = truth.path(), []
    least = min(30.0, path[-1] / 4)
    for i in range(0, len(truth), max(1, len(truth) // 150)):
        distances = np.linalg.norm(truth.positions - truth.positions[i], axis=1)
        distances[(path - path[i] <= least) | (distances >= 6)] = np.inf
        j = int(np.argmin(distances))
        if np.isfinite(distances[j]):
            pairs.append((i, j))
    return pairs[:60]


def ghosting(sequence, trajectory, truth):
    frames, gaps = frames_of(sequence), []
    for i, j in revisits(truth):
        a, b = points_of(frames[i]), points_of(frames[j])
        a = a[::max(1, len(a) // 2000)]
        r, t = trajectory.motion(j, i)
        distances, _ = cKDTree(b).query(a @ r.T + t)
        lower = distances[distances < np.quantile(distances, 0.8)]
        gaps.append(np.sqrt(np.mean(lower**2)))
    return (float(np.median(gaps)) if gaps else None), len(gaps)


def judge(sequence, trajectory, clouds=False):
    """What `plumb evaluate --json` prints, reckoned anew."""
    truth, result = Trajectory.read(Path(sequence) / "truth.tum"), {}
    for name, file in ("before", Path(sequence) / "odometry.tum"), ("after", trajectory):
        estimate, true = paired(Trajectory.read(file), truth)
        rmse, most = absolute_error(estimate, true)
        length, angle = relative_error(estimate, true)
        result[name] = {"poses": len(estimate), "ate_rmse": rmse, "ate_max": most, "rpe_m": length, "rpe_deg": angle}
        if clouds and len(estimate) == len(truth):
            gap, pairs = ghosting(sequence, estimate, true)
            result[name] |= {"ghosting": gap, "ghosting_truth": ghosting(sequence, true, true)[0], "pairs": pairs}
    return result
