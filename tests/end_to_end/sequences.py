"""Makes the small sequences that the cases run on, once for all of them (the ctest fixture).

street    out and back, 90 scans 2 m apart of 16 x 512 rays, drift of 4 m: every place is seen twice
straight  30 scans 1 m apart on a way that never returns, along a TUM file
walk      out and back on foot: 90 scans 0.3 m apart, of a denser scanner that sees 40 m
"""
import math
import shutil

from plumb_test import SEQUENCES, plumb

SCANNER = ["--lines", 16, "--columns", 512]


def way_without_return(file, frames):
    """Poses 1 m apart along x, swaying a little so that the positions are no singular line."""
    with open(file, "w") as out:
        for k in range(frames):
            yaw = 0.05 * math.sin(0.2 * k)
            out.write(f"{0.1 * k:.6f} {k} {0.25 * (1 - math.cos(0.2 * k)):.6f} 0 0 0 {math.sin(yaw / 2):.9f} {math.cos(yaw / 2):.9f}\n")


def main():
    shutil.rmtree(SEQUENCES, ignore_errors=True)
    SEQUENCES.mkdir(parents=True)
    plumb("simulate", "out_and_back", "--frames", 90, "--length", "180m", *SCANNER, "--drift", 4, "-o", SEQUENCES / "street")
    plumb("simulate", "out_and_back", "--frames", 90, "--length", "27m", "--lines", 32, "--columns", 512, "--range", "40m",
          "--lowest", "-35deg", "--highest", "35deg", "--drift", 1, "-o", SEQUENCES / "walk")
    way_without_return(SEQUENCES / "way.tum", 30)
    plumb("simulate", "--path", SEQUENCES / "way.tum", *SCANNER, "--drift", 0.5, "-o", SEQUENCES / "straight")


if __name__ == "__main__":
    main()
