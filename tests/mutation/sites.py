"""The places of a source file that can be mutated, and how each would read."""

import dataclasses
import random
import re

from cpp_tokens import Source

WORDS = {"return", "else", "do", "throw", "case", "co_return"}
ASSIGNMENTS = {"=", "+=", "-=", "*=", "/="}
LOGICAL = {"&&", "||"}
STATEMENT = {";"} | WORDS
OPERAND = STATEMENT | ASSIGNMENTS | {",", "?", ":", "|=", "&=", "%="}
EXPRESSION = OPERAND | LOGICAL
SUMS = {"+", "-", "<", ">", "<=", ">=", "==", "!=", "<<", ">>", "&", "|", "^"}
PRODUCTS = SUMS | {"*", "/", "%"}
ARITHMETIC = {"+": "-", "-": "+", "*": "/", "/": "*"}
BOUNDARIES = {"<": "<=", "<=": "<", ">": ">=", ">=": ">"}
OPPOSITES = {"<": ">=", "<=": ">", ">": "<=", ">=": "<", "==": "!=", "!=": "=="}
COMPOUND = {"+=": "-=", "-=": "+=", "*=": "/=", "/=": "*="}
FUNCTIONS = {"min": "max", "max": "min", "sin": "cos", "cos": "sin", "floor": "ceil",
             "ceil": "floor"}
# Of statements that are compiled away, or decide what is compiled.
NOT_IN = {"static_assert", "assert", "template", "using", "typedef", "enum", "operator", "friend"}


@dataclasses.dataclass
class Site:
    """`text`, instead of what stands at `start` to `end` in `file`."""
    file: str
    line: int
    kind: str
    start: int
    end: int
    text: str       # "" for a statement that is left out
    place: int      # of the operator or constant that changes
    constexpr: int  # where the word stands that must become const, or -1

    def lines(self, source):
        return range(source.count("\n", 0, self.start) + 1, source.count("\n", 0, self.end) + 2)


class Finder:
    def __init__(self, file, text):
        self.file = file
        self.source = Source(text)
        self.tokens = self.source.tokens
        self.found = []

    def find(self):
        for i, token in enumerate(self.tokens):
            if token.kind == "number":
                self.constant(i)
            elif token.kind == "word":
                self.word(i)
            elif token.kind == "sign":
                self.sign(i)
        return self.found

    def sign(self, i):
        text = self.tokens[i].text
        if text == "-" and not self.tokens[i].spaced_after and self.begins_operand(i):
            self.replace(i, "sign", i, i, "", EXPRESSION)
        elif text == "!" and not self.tokens[i].spaced_after:
            self.replace(i, "logic", i, i, "", EXPRESSION)
        elif text == "[" and not self.tokens[i].spaced_before and i in self.source.partner:
            self.index(i)
        elif text == ";":
            self.statement(i)
        if not self.source.is_binary(i):
            return
        if text in ARITHMETIC:
            self.replace(i, "arithmetic", i, i, ARITHMETIC[text], EXPRESSION)
            stops = EXPRESSION | (SUMS if text in "+-" else PRODUCTS)
            self.replace(i, "dropped term", i, self.source.end_of_expression(i + 1, stops), "",
                         EXPRESSION)
        elif text in OPPOSITES:
            self.replace(i, "comparison", i, i, OPPOSITES[text], EXPRESSION)
            if text in BOUNDARIES:
                self.replace(i, "boundary", i, i, BOUNDARIES[text], EXPRESSION)
        elif text in LOGICAL:
            self.replace(i, "logic", i, i, "||" if text == "&&" else "&&", OPERAND)
        elif text in COMPOUND:
            self.replace(i, "arithmetic", i, i, COMPOUND[text], STATEMENT)

    def word(self, i):
        text = self.tokens[i].text
        if text in FUNCTIONS and self.source.is_sign(i - 1, ["::"]) \
                and self.tokens[i - 2].text in ("std", "glm") and self.source.is_sign(i + 1, "("):
            self.replace(i, "function", i, i, FUNCTIONS[text], EXPRESSION)
        elif text in ("true", "false"):
            self.replace(i, "logic", i, i, "false" if text == "true" else "true", EXPRESSION)

    def constant(self, i):
        text = self.tokens[i].text
        if self.tokens[i - 1].text == "<" and not self.tokens[i - 1].spaced_before:
            return  # an argument of a template, as below
        if self.source.is_sign(i + 1, ">") and not self.tokens[i + 1].spaced_before:
            return
        if text.startswith("0x") or not re.match(r"[\d.']+([eE][+-]?\d+)?[fuzUZ]*$", text):
            return
        if re.search(r"[.eE]", text):
            if float(text.rstrip("f").replace("'", "")) != 0:
                factor = "1.01f" if text.endswith("f") else "1.01"
                self.replace(i, "constant", i, i, f"({factor} * {text})", EXPRESSION)
        else:
            self.replace(i, "constant", i, i, f"({text} + 1)", EXPRESSION)

    def index(self, i):
        end = self.source.partner[i]
        if self.tokens[i - 1].kind == "sign" and self.tokens[i - 1].text not in ")]" or end == i + 1:
            return
        inner = self.source.text[self.tokens[i].end:self.tokens[end].start]
        if "," in inner or '"' in inner:
            return
        for shift in ("+ 1", "- 1"):
            self.add(i, "index", i + 1, end - 1, f"({flat(inner)}) {shift}")

    def statement(self, i):
        """A statement that assigns or calls, left out."""
        first = self.source.expression_around(i - 1, STATEMENT)[0] if i > 0 else i
        if first >= i or self.source.is_sign(i - 1, OPEN_BLOCK) or \
                not self.source.is_sign(first - 1, "{};)") and self.tokens[first - 1].text != "else":
            return
        if self.tokens[first - 1].text == "{" and self.source.initialises(first - 1):
            return
        assigned = next((k for k in self.top_level(first, i)
                         if self.source.is_sign(k, ASSIGNMENTS)), None)
        if assigned is None and not (self.source.is_sign(i - 1, ")") or
                                     self.tokens[first].text == "continue"):
            return
        words = self.top_level(first, i if assigned is None else assigned)
        for a, b in zip(words, words[1:]):
            if self.tokens[b].kind == "word" and (self.tokens[a].kind == "word" or
                                                  self.source.is_sign(a, "<>*&")):
                return  # a declaration
        if self.tokens[first].kind != "word" and not self.source.is_sign(first, "*("):
            return
        self.add(first, "dropped statement", first, i, "")

    def top_level(self, first, end):
        k, found = first, []
        while k < end:
            found.append(k)
            k = self.source.partner[k] + 1 if self.source.is_sign(k, "([{") else k + 1
        return found

    def begins_operand(self, i):
        before = self.tokens[i - 1]
        return before.text in WORDS or (before.kind == "sign" and before.text not in ")]}")

    def replace(self, place, kind, first, last, by, stops):
        """What tokens `first` to `last` say replaced, within the expression around them."""
        begin, end = self.source.expression_around(place, stops)
        text = self.source.text
        start, stop = self.tokens[begin].start, self.tokens[end].end
        if not (start <= self.tokens[first].start and self.tokens[last].end <= stop):
            return
        after = text[self.tokens[last].end:stop]
        self.add(place, kind, begin, end, text[start:self.tokens[first].start] + by + after)

    def add(self, place, kind, first, last, text):
        begin = place
        while begin > 0 and not (self.source.is_sign(begin - 1, ";}") or
                                 self.source.is_sign(begin - 1, "{") and
                                 not self.source.initialises(begin - 1)):
            begin -= 1
        words = [k for k in range(begin, place + 1) if self.tokens[k].kind == "word"]
        if any(self.tokens[k].text in NOT_IN for k in words):
            return
        at = next((self.tokens[k].start for k in words if self.tokens[k].text == "constexpr" and
                   not self.source.is_sign(k + 1, "(")), -1)
        # What members are before they are set.
        if self.file.endswith(".h") and kind in ("constant", "logic") and at < 0 and \
                self.source.is_sign(place - 1, "=") and self.source.is_sign(place + 1, ";"):
            return
        start = self.tokens[place].start
        self.found.append(Site(self.file, self.source.line_of(start), kind, self.tokens[first].start,
                               self.tokens[last].end, flat(text), start, at))


OPEN_BLOCK = "{}"


def flat(text):
    """On one line and without comments."""
    return re.sub(r"\s+", " ", re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.DOTALL)).strip()


def draw(areas, seed):
    """The sites of all areas ({name: [Site]}) in an order drawn from `seed`: by turns from each
    area, of each kind of mutation alike."""
    chance = random.Random(seed)
    kinds = {}
    for area, sites in areas.items():
        kinds[area] = {}
        for site in sites:
            kinds[area].setdefault(site.kind, []).append(site)
        for group in kinds[area].values():
            chance.shuffle(group)
    drawn = []
    while any(kinds.values()):
        for area in areas:
            if kinds[area]:
                kind = chance.choice(sorted(kinds[area]))
                drawn.append(kinds[area][kind].pop())
                if not kinds[area][kind]:
                    del kinds[area][kind]
    return drawn
