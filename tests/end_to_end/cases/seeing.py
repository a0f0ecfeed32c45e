"""What a run tells of itself: --events, --trace, the table of times and memory."""
import json
import re

from plumb_test import CASCADE, STEP_FAILED, WRONG_INPUT, copy_of, files_of, plumb, refused, sequence

FAST = ["--set", "ranges.frames=10"]


def run(folder, out, *options, seen=None, code=0):
    return plumb("run", CASCADE, "--set", f"input={seen or sequence('street')}", *FAST, *options, "-o", folder / out, code=code)


def table(said):
    """By step: CPU seconds, MiB, items made, items remembered."""
    lines = said.out.split("CPU seconds of each step")[1].splitlines()[1:]
    rows = (re.fullmatch(r"  (\S+) +([\d.]+) +(\d+)  \((\d+), (\d+)\)", line) for line in lines)
    return {row[1]: (float(row[2]), int(row[3]), int(row[4]), int(row[5])) for row in rows if row}


def events_of(file):
    return [json.loads(line) for line in file.read_text().splitlines()]


def items_by_step(items):
    """By step: made, reused."""
    counts = {}
    for step, reused in items:
        made = counts.setdefault(step, [0, 0])
        made[1 if reused else 0] += 1
    return counts


def test_the_trace_is_json_with_a_span_for_each_item(folder):
    said = run(folder, "out", "--trace", folder / "trace.json")
    trace = json.loads((folder / "trace.json").read_text())["traceEvents"]
    spans = [event for event in trace if event["ph"] == "X"]
    items = [event["args"] for event in spans if event["cat"] == "item"]
    expected = {step: [made, reused] for step, (_, _, made, reused) in table(said).items()}
    assert items_by_step((item["step"], item["reused"]) for item in items for _ in range(item.get("items", 1))) == expected
    assert all(event["dur"] >= 0 and event["ts"] >= 0 and event["pid"] and event["tid"] >= 0 for event in spans)
    assert {"process_name", "thread_name"} <= {event["name"] for event in trace if event["ph"] == "M"}
    assert {item["item"] for item in items if item["step"] == "kept" or item["step"].startswith("drift.")} > {""}
    ends = max(event["ts"] + event["dur"] for event in spans)
    (whole,) = [event for event in spans if event["cat"] == "run_ends"]
    assert ends <= whole["dur"] + 1


def test_spans_of_one_thread_lie_inside_or_beside_each_other(folder):
    run(folder, "out", "--trace", folder / "trace.json", "--threads", 2)
    spans = [e for e in json.loads((folder / "trace.json").read_text())["traceEvents"] if e["ph"] == "X"]
    for track in {(e["pid"], e["tid"]) for e in spans}:
        open_until = []
        for span in sorted((e for e in spans if (e["pid"], e["tid"]) == track), key=lambda e: (e["ts"], -e["dur"])):
            begin, end = span["ts"], span["ts"] + span["dur"]
            while open_until and open_until[-1] <= begin + 1e-2:
                open_until.pop()
            assert not open_until or end <= open_until[-1] + 50, (span, open_until)  # microseconds
            open_until.append(end)


def test_the_events_come_a_line_each_and_say_what_was_reused(folder):
    run(folder, "first", "--events", folder / "first.jsonl", "--cache-dir", folder / "store")
    said = run(folder, "again", "--events", folder / "again.jsonl", "--cache-dir", folder / "store")
    first, again = events_of(folder / "first.jsonl"), events_of(folder / "again.jsonl")
    assert first[0]["event"] == "run_begins" and first[-1]["event"] == "run_ends" and "sentence" not in first[-1]
    assert first[-1]["peak_bytes"] > 10 << 20 and first[-1]["cpu_seconds"] > 0
    items = [e for e in again if e["event"] == "item"]
    assert sum(not item["reused"] for item in items) <= 2 < sum(item.get("items", 1) for item in items if item["reused"])
    assert items_by_step((item["step"], item["reused"]) for item in items for _ in range(item.get("items", 1))) == {s: [m, r] for s, (_, _, m, r) in table(said).items()}
    assert any(e["event"] == "item" and e["item"].startswith("edge ") and e.get("pass") == 1 for e in first)
    for kind in ("step_begins", "step_ends", "pass_begins"):
        assert any(e["event"] == kind for e in first), kind


def test_neither_changes_the_results_or_lies_among_them(folder):
    run(folder, "plain")
    run(folder, "told", "--events", folder / "e", "--trace", folder / "t", "--log", folder / "l")
    assert files_of(folder / "plain") == files_of(folder / "told")


def test_they_replace_their_like_and_nothing_else(folder):
    (folder / "thesis.txt").write_text("mine\n")
    for option, what in ("--events", "no events of plumb"), ("--trace", "no trace of plumb"):
        refused(run(folder, "out", option, folder / "thesis.txt", code=WRONG_INPUT), "thesis.txt", what)
        refused(run(folder, "out", option, folder / "out/file", code=WRONG_INPUT), "beside")
        refused(run(folder, "out", option, folder / "none/file", code=WRONG_INPUT), "folder that exists")
        refused(run(folder, "out", option, folder / "one", "--log", folder / "one", code=WRONG_INPUT), "--log writes too")
    assert (folder / "thesis.txt").read_text() == "mine\n" and not (folder / "out").exists()
    for _ in range(2):
        run(folder, "out", "--events", folder / "e", "--trace", folder / "t")
        assert events_of(folder / "e")[0]["event"] == "run_begins" and json.loads((folder / "t").read_text())
    refused(run(folder, "out", "--events", folder / "t", code=WRONG_INPUT), "no events of plumb")


def test_a_run_that_fails_says_why_in_all_of_them(folder):
    broken = copy_of("street", folder)
    frame = sorted((broken / "frames").iterdir())[50]
    frame.write_bytes(frame.read_bytes()[:200])
    run(folder, "out", "--events", folder / "e", "--trace", folder / "t", seen=broken, code=STEP_FAILED)
    last = events_of(folder / "e")[-1]
    assert last["event"] == "run_ends" and frame.name in last["sentence"], last
    assert json.loads((folder / "t").read_text())["traceEvents"][-1]["args"]["sentence"] == last["sentence"]


def test_times_and_memory_stand_at_the_end_of_each_run(folder):
    rows = table(run(folder, "out"))
    assert rows["fine.solved"][1] > 5 and all(mib > 0 for _, mib, _, _ in rows.values()), rows
    assert "CPU seconds" not in run(folder, "out", "--no-times").out
    assert not run(folder, "out", "--quiet").out
