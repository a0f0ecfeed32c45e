#!/usr/bin/env python3
"""Computes every ratio, difference, interval and p of a result of `plumb compare --save RESULT.json` once more, from its runs alone, and compares.

    python3 tools/recomputed.py RESULT.json

A second way: p by scipy.stats.permutation_test over all signs; its interval by looking for the differences at which that p crosses 5 %; intervals by
resampling with numpy's random numbers, forty times, so that it is known how far two of them differ by chance; Holm's correction from its definition.
Exit 1 where anything differs: what is exact by more than rounding, what is drawn by more than six standard deviations. Debian: python3-numpy, python3-scipy.
"""
import argparse
import collections
import itertools
import json
import math
import sys
from pathlib import Path

import numpy as np
from scipy import stats

ALPHA, REPEATS, SIGMAS, ROUNDING = 0.05, 40, 6, 1e-6
MOST_EXACT = 16  # inputs of which all signs are taken here
FEWEST_INPUTS, FEWEST_REPLICATES, FEWEST_SEGMENTS = 6, 3, 2


class Differs(Exception):
    pass


def require(holds, *what):
    if not holds:
        raise Differs(" ".join(map(str, what)))


def figures_of(outcome, number):
    """{(variant, input, replicate): the figure}."""
    return {(run["variant"], run["input"], run["replicate"]): figure for run in outcome["runs"] for figure in run["numbers"] if figure["name"] == number}


def pairs_of(outcome, number, variant):
    """By input the pairs of figures of the runs in which both gave the number; times from a cache count as none."""
    figures, reference = figures_of(outcome, number["name"]), outcome["variants"][0]
    found = {}
    for name in outcome["inputs"]:
        both = [(figures.get((reference, name, r)), figures.get((variant, name, r))) for r in range(1, outcome["replicates"]["count"] + 1)]
        both = [(a, b) for a, b in both if a and b and not a.get("cached") and not b.get("cached")]
        if both:
            found[name] = both
    return found


def contrast(scale, a, b):
    return np.log(b / a) if scale == "ratio" else b - a


def value_of(segments, weights):
    """Of draws: `weights` has a row each, with how often each segment was drawn."""
    n, m = weights.shape[1], len(segments["sum"])
    weights = weights[:, np.arange(m) * n // m]
    with np.errstate(invalid="ignore", divide="ignore"):  # a draw that misses everything gives no number and is left out
        mean = (weights @ np.array(segments["sum"])) / (weights @ np.array(segments["count"]))
    return np.sqrt(mean) if segments["root"] else mean


def drawn_ends(scale, pairs, by_segment, draws, random):
    """The interval of one bootstrap."""
    total = np.zeros(draws)
    for runs in pairs.values():
        if by_segment:
            n = len(runs[0][0]["segments"]["sum"])
            weights = random.multinomial(n, np.full(n, 1 / n), size=draws).astype(float)
            contrasts = [contrast(scale, value_of(a["segments"], weights), value_of(b["segments"], weights)) for a, b in runs]
            total += np.mean(contrasts, axis=0)
        else:
            contrasts = np.array([contrast(scale, a["value"], b["value"]) for a, b in runs])
            total += contrasts[random.integers(0, len(runs), (draws, len(runs)))].mean(axis=1)
    return np.quantile(total[np.isfinite(total)] / len(pairs), (ALPHA / 2, 1 - ALPHA / 2))


def method_of(pairs, contrasts):
    """What the numbers allow."""
    if all(contrast == 0 for each in contrasts for contrast in each):
        return "identical"
    if len(pairs) >= FEWEST_INPUTS:
        return "sign-flip over inputs"
    figures = [figure for runs in pairs.values() for both in runs for figure in both]
    if all(len(figure.get("segments", {}).get("sum", [])) >= FEWEST_SEGMENTS for figure in figures):
        return "bootstrap over segments"
    return "bootstrap over replicates" if all(len(runs) >= FEWEST_REPLICATES for runs in pairs.values()) else "none"


def sign_flip_ends(differences):
    """The differences that the test does not refute, by bisection."""
    signs = np.array(list(itertools.product((1.0, -1.0), repeat=len(differences))))

    def p(centre):
        d = np.array(differences) - centre
        return np.mean(np.abs(signs @ d) >= abs(d.sum()) - 1e-12 * max(1, np.abs(d).max()))

    def edge(inside, outside):
        for _ in range(60):
            middle = (inside + outside) / 2
            inside, outside = (middle, outside) if p(middle) > ALPHA else (inside, middle)
        return inside

    mean, width = np.mean(differences), np.ptp(differences) + 1e-9
    return edge(mean, mean - width), edge(mean, mean + width)


def check_sign_flip(found, interval, differences):
    d = np.array(differences)
    test = stats.permutation_test((d, np.zeros(len(d))), lambda x, y, axis: np.mean(x - y, axis=axis), vectorized=True, permutation_type="samples",
                                  n_resamples=np.inf)
    require(abs(found["p"] - test.pvalue) < 1e-9, "p is", found["p"], "and by scipy", test.pvalue)
    low, high = sign_flip_ends(d)
    require(np.allclose(interval, (low, high), rtol=0, atol=ROUNDING * max(high - low, 1e-3)), "the interval is", interval, "and once more", (low, high))


def check_drawn(interval, scale, pairs, by_segment, draws):
    random = np.random.default_rng(1)
    ends = np.array([drawn_ends(scale, pairs, by_segment, draws, random) for _ in range(REPEATS)])
    far = np.abs(np.array(interval) - ends.mean(axis=0)) / (ends.std(axis=0, ddof=1) + 1e-12)
    require(far.max() <= SIGMAS, "the interval is", interval, "and once more", ends.mean(axis=0), "give or take", ends.std(axis=0, ddof=1))
    return far.max()


def check(outcome, number, variant):
    """Of one comparison: (method, how far off in standard deviations)."""
    found, scale = number["variants"][variant]["against"], number["scale"]
    pairs = pairs_of(outcome, number, variant)
    require(list(pairs) == found["inputs"], "inputs are", found["inputs"], "and once more", list(pairs))
    if not pairs:
        return "none", 0
    plain = math.log if scale == "ratio" else float
    contrasts = [[float(contrast(scale, a["value"], b["value"])) for a, b in runs] for runs in pairs.values()]
    differences = [float(np.mean(each)) for each in contrasts]
    require(np.allclose([plain(value) for value in found["by_input"]], differences, rtol=1e-9, atol=1e-12), "by input", found["by_input"], differences)
    estimate = plain(found["ratio" if scale == "ratio" else "difference"])
    require(math.isclose(estimate, np.mean(differences), rel_tol=1e-9, abs_tol=1e-12), "the mean is", estimate, np.mean(differences))
    method = method_of(pairs, contrasts)
    require(method == found["method"], "the method is", found["method"], "and should be", method)
    require(("interval" in found) == (method != "none"), "whether there is an interval")
    if method == "none":
        return method, 0
    interval = [plain(end) for end in found["interval"]]
    if method == "identical":
        require(interval == [0, 0], "the interval is", interval)
    elif method == "sign-flip over inputs":
        if len(pairs) > MOST_EXACT:
            return f"not looked at: more than {MOST_EXACT} inputs", 0
        check_sign_flip(found, interval, differences)
    else:
        return method, check_drawn(interval, scale, pairs, "segments" in method, outcome["bootstrap"]["draws"])
    return method, 0


def check_holm(number):
    """The i-th smallest p times the number of those that are not smaller, and never less than one before."""
    found = [of["against"] for of in number["variants"].values() if "against" in of]
    p = [each.get("p", 1) for each in found]
    most, adjusted = 0, {}
    for rank, k in enumerate(sorted(range(len(p)), key=lambda k: p[k])):
        adjusted[k] = most = max(most, min(1, (len(p) - rank) * p[k]))
    for k, each in enumerate(found):
        if "p" in each:
            expected = each["p"] if number["exploratory"] else adjusted[k]
            require(math.isclose(each["adjusted_p"], expected, rel_tol=1e-12), "the adjusted p is", each["adjusted_p"], "and once more", expected)


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("result", type=Path, metavar="RESULT.json")
    outcome = json.loads(arguments.parse_args().result.read_text())
    if outcome["reference"] != outcome["variants"][0]:
        sys.exit(f"it compares with {outcome['reference']}, whose runs are not in it")
    compared, farthest, faults = collections.Counter(), 0, []
    for number in outcome["numbers"]:
        for variant, of in number["variants"].items():
            if "against" not in of:
                continue
            try:
                method, far = check(outcome, number, variant)
                compared[method] += 1
                farthest = max(farthest, far)
            except Differs as fault:
                faults.append(f"{number['name']}, {variant}: {fault}")
        try:
            check_holm(number)
        except Differs as fault:
            faults.append(f"{number['name']}: {fault}")
    for method, count in compared.items():
        print(f"{count} comparisons, {method}: the same once more")
    print(f"what is drawn lies {farthest:.1f} standard deviations off at most")
    print("\n".join(faults + [f"{len(faults)} differ"]))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
