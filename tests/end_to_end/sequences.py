"""Makes the small sequences that the cases run on, once for all of them (the ctest fixture).

street    out and back, 60 scans 1 m apart of 16 x 512 rays, drift of 1.5 m: every place is seen twice
straight  30 scans along a line that never returns, along a given TUM file
walk      out and back by hand's speed: 60 scans 0.25 m apart, of a denser, shorter-sighted scanner
"""
import math
import shutil

from plumb_test import SEQUENCES, plumb

SCANNER = ["--lines", "16", "--columns", "512"]


def straight_line(file, frames):
    """Poses 1 m apart along x, driving along a gentle wave so that the path is no singular line."""
    with open(file, "w") as out:
        for k in range(frames):
            yaw = 0.05 * math.sin(0.2 * k)
            out.write(f"{0.1 * k:.6f} {k} {0.25 * (1 - math.cos(0.2 * k)):.6f} 0 0 0 {math.sin(yaw / 2):.9f} {math.cos(yaw / 2):.9f}\n")


def main():
    shutil.rmtree(SEQUENCES, ignore_errors=True)
    SEQUENCES.mkdir(parents=True)
    plumb("simulate", "out_and_back", "--frames", 60, *SCANNER, "--drift", 1.5, "-o", SEQUENCES / "street")
    line = SEQUENCES / "line.tum"
    straight_line(line, 30)
    plumb("simulate", "--path", line, *SCANNER, "--drift", 0.2, "-o", SEQUENCES / "straight")
    plumb("simulate", "out_and_back", "--frames", 60, "--length", "30m", "--lines", 32, "--columns", 512, "--range", "40m",
          "--lowest", "-35deg", "--highest", "35deg", "--drift", 0.5, "-o", SEQUENCES / "walk")


if __name__ == "__main__":
    main()
