"""Shows that every kind of mutation is found, and what is no place for one is not."""

import sites
from schemata import mutated_text

SAMPLE = """\
// a - b
constexpr double k_half = 0.5;
static_assert(k_half < 1);
double f(const std::vector<double>& x, int i) {
    if (i < 2 && !(x[i] > 0)) return -k_half;
    double sum = std::max(x[0] * 2, x[1]);  // a + b
    sum += k_half;
    const std::array<double, 3> none{};
    return sum - none[2];
}
"""
# Line, kind, what is written there instead.
WANTED = {
    (2, "constant", "(1.01 * 0.5)"),
    (5, "comparison", "i >= 2"),
    (5, "boundary", "i <= 2"),
    (5, "constant", "i < (2 + 1)"),
    (5, "logic", "i < 2 || !(x[i] > 0)"),
    (5, "logic", "(x[i] > 0)"),
    (5, "index", "(i) + 1"),
    (5, "index", "(i) - 1"),
    (5, "comparison", "x[i] <= 0"),
    (5, "boundary", "x[i] >= 0"),
    (5, "constant", "x[i] > (0 + 1)"),
    (5, "sign", "k_half"),
    (6, "function", "std::min(x[0] * 2, x[1])"),
    (6, "arithmetic", "x[0] / 2"),
    (6, "dropped term", "x[0]"),
    (6, "constant", "x[0] * (2 + 1)"),
    (6, "constant", "(0 + 1)"),
    (6, "constant", "(1 + 1)"),
    (6, "index", "(0) + 1"),
    (6, "index", "(0) - 1"),
    (6, "index", "(1) + 1"),
    (6, "index", "(1) - 1"),
    (7, "arithmetic", "sum -= k_half"),
    (7, "dropped statement", ""),
    (9, "arithmetic", "sum + none[2]"),
    (9, "dropped term", "sum"),
    (9, "index", "(2) + 1"),
    (9, "index", "(2) - 1"),
    (9, "constant", "(2 + 1)"),
}


def problems():
    """What is wrong, line by line."""
    found = sites.Finder("sample.cpp", SAMPLE).find()
    said = {(site.line, site.kind, site.text) for site in found}
    wrong = [f"not found: {mutant}" for mutant in sorted(WANTED - said)]
    wrong += [f"no mutation: {mutant}" for mutant in sorted(said - WANTED)]
    text = mutated_text(SAMPLE, dict(enumerate(found, 1)))
    wrong += [f"not in the source: {site}" for number, site in enumerate(found, 1)
              if f"is_mutant({number})" not in text]
    if text.count("\n") != SAMPLE.count("\n") + 2:
        wrong.append("lines moved")
    if "constexpr" in text or "const double k_half = (uw::is_mutant(" not in text:
        wrong.append("a mutated constant is constexpr")
    return wrong
