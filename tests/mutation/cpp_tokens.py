"""C++ as tokens with their places, as far as the finding of mutations needs it. It relies on the
project's formatting: operators between two operands have spaces around them, those before one and
the brackets of templates have none, and initialisers have no space before their brace."""

import dataclasses
import re

PATTERN = re.compile(r"""
    (?P<skip>   \s+ | //[^\n]* | /\*.*?\*/ | ^[ \t]*\#(?:[^\n\\]|\\\n|\\.)*)
  | (?P<string> R"(?P<delimiter>[^(\s]*)\(.*?\)(?P=delimiter)" | "(?:[^"\\\n]|\\.)*" | '(?:[^'\\\n]|\\.)+')
  | (?P<number> (?:\d[\d']*\.?[\d']*|\.\d[\d']*)(?:[eE][+-]?\d+)?[a-zA-Z_]*)
  | (?P<word>   [A-Za-z_]\w*)
  | (?P<sign>   <=>|->\*|<<=|>>=|\.\.\.|::|->|\+\+|--|&&|\|\||[-+*/%&|^<>=!]=|<<|.)
""", re.VERBOSE | re.DOTALL | re.MULTILINE)
OPEN, CLOSE = "([{", ")]}"
CONTROL = {"if", "for", "while", "switch", "constexpr", "catch"}


@dataclasses.dataclass
class Token:
    kind: str
    text: str
    start: int
    end: int
    spaced_before: bool = False
    spaced_after: bool = False


class Source:
    """The tokens of a file, and for each bracket the index of its partner."""

    def __init__(self, text):
        self.text = text
        self.tokens = []
        for match in PATTERN.finditer(text):
            if match.lastgroup == "skip":
                continue
            kind = "string" if match.group("string") else match.lastgroup
            self.tokens.append(Token(kind, match.group(), match.start(), match.end()))
        self.partner = {}
        opened = []
        for i, token in enumerate(self.tokens):
            token.spaced_before = text[token.start - 1:token.start].isspace()
            token.spaced_after = text[token.end:token.end + 1].isspace()
            if token.kind != "sign":
                continue
            if token.text in OPEN:
                opened.append(i)
            elif token.text in CLOSE and opened:
                self.partner[i] = opened.pop()
                self.partner[self.partner[i]] = i

    def is_sign(self, i, texts):
        return 0 <= i < len(self.tokens) and self.tokens[i].kind == "sign" \
            and self.tokens[i].text in texts

    def is_binary(self, i):
        token = self.tokens[i]
        return token.kind == "sign" and token.spaced_before and token.spaced_after

    def initialises(self, brace):
        """Whether this opening brace is that of `Type{...}`, no block's."""
        return not self.tokens[brace].spaced_before

    def expression_around(self, i, stops):
        """The first and last token of the expression with token `i`, between `stops` or the
        brackets that hold it."""
        first = i
        while first > 0:
            j = first - 1
            token = self.tokens[j]
            if token.kind == "sign" and token.text in CLOSE:
                opening = self.partner.get(j)
                if opening is None or (token.text == "}" and not self.initialises(opening)) \
                        or self.tokens[opening - 1].text in CONTROL:
                    break
                first = opening
                continue
            if token.text in stops or (token.kind == "sign" and token.text in OPEN):
                break
            first = j
        return first, self.end_of_expression(i, stops)

    def end_of_expression(self, i, stops):
        last = i
        if self.is_sign(i, OPEN):
            last = self.partner[i]
        while last + 1 < len(self.tokens):
            j = last + 1
            token = self.tokens[j]
            if token.kind == "sign" and token.text in OPEN:
                if j not in self.partner or (token.text == "{" and not self.initialises(j)):
                    break
                last = self.partner[j]
                continue
            if token.kind == "sign" and token.text in CLOSE or token.text in stops:
                break
            last = j
        return last

    def line_of(self, offset):
        return self.text.count("\n", 0, offset) + 1
