"""What a render could not show, each said once."""


class Notes:
    def __init__(self):
        self.texts = []

    def add(self, text):
        if text not in self.texts:
            self.texts.append(text)


class Refusal(Exception):
    """The scene cannot be rendered; the text says why, and how to mend it."""

    is_by_program = False  # in its words, which words.py translates
