"""A sweep of the cascade over its voxels and correspondence distances on two sequences: a table, a plot, and a gate for what comes later."""
import csv
import itertools
import json
from xml.etree import ElementTree

from plumb_test import BUILD, CASCADE, DONE, WORSE, plumb, sequence

# The cascade with a last step that can make its poses worse.
JUDGED = f"""plumb: 1
name: judged
extends: {CASCADE}
remove: [map]
add:
  worsened: {{use: test.worse_poses, from: straight, with: {{truth: $truth}}}}
replace:
  error: {{use: measure.trajectory, from: {{trajectories: {{drift: after_drift, coarse: after_coarse, fine: worsened}}}}, with: {{truth: $truth}}}}
  trajectory: {{use: write.trajectory, from: worsened}}
"""
VOXELS = ("0.3m", "0.5m")
DISTANCES = ("[4m,2m,1m]", "[2m,1m,0.5m]")
INPUTS = ("street", "straight")


def compare(folder, *words, code):
    inputs = [word for name in INPUTS for word in ("--input", sequence(name))]
    return plumb("--plugin-path", BUILD / "tests/end_to_end/modules", "compare", folder / "judged.yaml", *inputs, "--set", "ranges.frames=6", "--primary",
                 "error.fine.ate", "--cache-dir", folder / "cache", "--quiet", *words, code=code)


def test_a_sweep_over_voxels_and_distances_is_a_table_a_plot_and_a_gate(folder):
    (folder / "judged.yaml").write_text(JUDGED)
    said = compare(folder, "--sweep", f"voxel_size={','.join(VOXELS)}", "--sweep", f"coarse.max_correspondence_distance={','.join(DISTANCES)}",
                   *(word for ending in ("csv", "md", "svg", "json") for word in ("--save", folder / f"sweep.{ending}")), code=(DONE, WORSE))
    print(said.out)
    rows = [row for row in csv.DictReader(open(folder / "sweep.csv")) if row["metric"] == "error.fine.ate"]
    swept = {(row["voxel_size"], row["coarse.max_correspondence_distance"], row["input"]): float(row["value"]) for row in rows if row["variant"] != "judged"}
    assert set(swept) == set(itertools.product(VOXELS, DISTANCES, INPUTS)) and len(rows) == len(swept) + len(INPUTS), rows
    as_it_is = {row["input"]: float(row["value"]) for row in rows if row["variant"] == "judged"}
    assert all(swept["0.3m", "[4m,2m,1m]", name] == as_it_is[name] for name in INPUTS), (swept, as_it_is)
    assert all(swept["0.3m", d, name] != swept["0.5m", d, name] for d, name in itertools.product(DISTANCES, INPUTS)), swept
    names = [f"voxel_size={v},coarse.max_correspondence_distance={d}" for v, d in itertools.product(VOXELS, DISTANCES)]
    page = (folder / "sweep.md").read_text()
    assert page.startswith("# judged\n") and all(page.count(v) >= 2 for v in VOXELS), page
    plot = ElementTree.parse(folder / "sweep.svg").getroot()
    shown = {text.text: float(text.get("x")) for text in plot.iter("{http://www.w3.org/2000/svg}text")}
    assert set(names) <= set(shown) and len(list(plot.iter("{http://www.w3.org/2000/svg}circle"))) == len(names), shown
    assert all(shown[name] > 6 * len(name) for name in names), shown  # they end there and begin on the page

    # What CI does with it: nothing is worse as long as nothing has changed.
    gate = ["--baseline", folder / "sweep.json", "--save", folder / "now.json"]
    compare(folder, *gate, code=DONE)
    compare(folder, *gate, "--set", "worsened.factor=1.2", code=WORSE).has("plumb: worse: judged is 20 % higher than in ", "on these data")
    found = next(number for number in json.loads((folder / "now.json").read_text())["numbers"] if number["name"] == "error.fine.ate")
    against = found["variants"]["judged"]["against"]
    assert against["verdict"] == "worse" and abs(against["ratio"] - 1.2) < 1e-3, against
