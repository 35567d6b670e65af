"""Names of landmarks: their sides, and the name of the landmark on the other side. Knows nothing of Blender."""
import re

# Each pair in both letter cases that people write; the longer words first, so that "left" is not read as an "l".
_WORDS = (("left", "right"), ("Left", "Right"), ("LEFT", "RIGHT"))
_LETTER = re.compile(r"^(?:(?P<front>[lLrR])(?P<after>[._\- ])|.*(?P<before>[._\- ])(?P<back>[lLrR])(?=$|\.\d+$))")
_OTHER = {"l": "r", "r": "l", "L": "R", "R": "L"}


def mirrored(name):
    """The name on the other side: elbow.L - elbow.R, LeftHand - RightHand, l_eye - r_eye; None without a side."""
    for left, right in _WORDS:
        for one, other in ((left, right), (right, left)):
            at = _word_at(name, one)
            if at >= 0:
                return name[:at] + other + name[at + len(one):]
    found = _LETTER.match(name)
    if not found:
        return None
    at = found.start("front") if found["front"] else found.start("back")
    return name[:at] + _OTHER[name[at]] + name[at + 1:]


def _word_at(name, word):
    """Where the word stands by itself: 'leftHand' and 'hand_left' do, 'cleft' and 'upright' do not."""
    at = name.find(word)
    while at >= 0:
        before, after = name[at - 1:at], name[at + len(word):at + len(word) + 1]
        if _ends_word(before, word[0]) and not (after.islower() and after.isalpha()):
            return at
        at = name.find(word, at + 1)
    return -1


def _ends_word(before, first):
    return not before.isalpha() or (before.islower() and first.isupper())


def missing_mirrors(names):
    """Names whose other side is among the names, but which are not there themselves."""
    present = set(names)
    return [other for other in map(mirrored, names) if other and other not in present]


def free_name(wanted, taken):
    """The name itself, or with the first free number: point, point.001, ..."""
    if wanted not in taken:
        return wanted
    number = 1
    while f"{wanted}.{number:03}" in taken:
        number += 1
    return f"{wanted}.{number:03}"
