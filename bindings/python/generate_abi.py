#!/usr/bin/env python3
"""Writes focal/_abi.py, the declarations of focal.h for ctypes, from the header itself.

    generate_abi.py [--check] [HEADER [OUT]]

Without arguments it reads include/focal/focal.h and writes focal/_abi.py beside this script. With --check nothing is
written: the exit status is 1 when the file is not what the header gives.

The header is plain C by a few forms only: opaque and full structs, integer typedefs each followed by its enum,
function pointers, functions, and #define of numbers. Anything else stops the generator with the text it did not
understand, so that nothing is left out silently.
"""
import argparse
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
HEADER = HERE.parent.parent / "include" / "focal" / "focal.h"
OUT = HERE / "focal" / "_abi.py"
WIDTH = 118

SCALARS = {
    "char": "c_char", "float": "c_float", "double": "c_double", "size_t": "c_size_t",
    "int8_t": "c_int8", "int16_t": "c_int16", "int32_t": "c_int32", "int64_t": "c_int64",
    "uint8_t": "c_uint8", "uint16_t": "c_uint16", "uint32_t": "c_uint32", "uint64_t": "c_uint64",
}


class HeaderError(Exception):
    """The header holds something that the generator does not know."""


class Declarations:
    """What the header declares, in its order."""

    def __init__(self):
        self.constants = {}  # name -> number, of #define
        self.enums = {}      # typedef name -> [(name, number)]
        self.opaque = []     # names of handle types
        self.structs = {}    # name -> [(field, ctypes expression)]
        self.callbacks = {}  # name -> (result, [argument])
        self.functions = {}  # name -> (result, [argument])


def without_comments(text):
    return re.sub(r"/\*.*?\*/|//[^\n]*", " ", text, flags=re.S)


def split_directives(text):
    """The C text that a C compiler sees with no macro defined, and the #define of numbers."""
    lines, constants, active = [], {}, [True]
    for line in text.replace("\\\n", " ").split("\n"):
        directive = re.match(r"\s*#\s*(\w+)\s*(.*)", line)
        if not directive:
            lines.append(line if all(active) else "")
            continue
        word, rest = directive.groups()
        if word in ("if", "ifdef", "ifndef"):
            active.append(word == "ifndef")
        elif word in ("elif", "else"):
            active[-1] = word == "else" and not active[-1]
        elif word == "endif":
            active.pop()
        elif word == "define" and all(active):
            number = re.match(r"(\w+)\s+(?:U?INT\d+_C\()?(0[xX][0-9a-fA-F]+|-?\d+)[uUlL]*\)?\s*$", rest)
            if number:
                constants[number[1]] = int(number[2], 0)
    return "\n".join(lines), constants


def statements(text):
    """Texts up to each ';' outside of braces, blanks made one."""
    depth, start, found = 0, 0, []
    for at, letter in enumerate(text):
        depth += (letter == "{") - (letter == "}")
        if letter == ";" and depth == 0:
            found.append(" ".join(text[start:at].split()))
            start = at + 1
    rest = text[start:].strip()
    if depth or rest:
        raise HeaderError(f"the header ends inside a declaration: {rest[:80]!r}")
    return [one for one in found if one]


def type_of(spelling, known):
    """The ctypes expression of a C type such as 'const char* const*'."""
    words = re.findall(r"\w+|\*", spelling)
    stars = words.count("*")
    names = [w for w in words if w not in ("const", "struct", "*")]
    if len(names) != 1:
        raise HeaderError(f"unknown type {spelling!r}")
    name = names[0]
    if name == "void":
        if stars == 0:
            return "None"
        result, stars = "c_void_p", stars - 1
    elif name == "char" and stars:
        result, stars = "c_char_p", stars - 1
    elif name in SCALARS or name in known:
        result = SCALARS.get(name, name)
    else:
        raise HeaderError(f"unknown type {spelling!r}")
    for _ in range(stars):
        result = f"P({result})"
    return result


def declarator(text, known):
    """(name, ctypes expression) of a field or an argument such as 'float position[3]'."""
    match = re.match(r"(.*?[\s*])(\w+)\s*((?:\[\s*\w+\s*\]\s*)*)$", text.strip())
    if not match:
        raise HeaderError(f"cannot read the declaration {text!r}")
    kind = type_of(match[1], known)
    for count in reversed(re.findall(r"\[\s*(\w+)\s*\]", match[3])):
        kind = f"{kind} * {int(count, 0)}"
    return match[2], kind


def fields_of(body, known):
    found = []
    for statement in body.split(";"):
        if not statement.strip():
            continue
        first, *others = statement.split(",")
        base = re.match(r"\s*((?:const\s+|struct\s+)*\w+)", first)[1]
        for text in [first] + [f"{base} {other}" for other in others]:
            found.append(declarator(text, known))
    return found


def arguments_of(text, known):
    text = text.strip()
    if text == "void" or not text:
        return []
    kinds = []
    for one in text.split(","):
        kind = declarator(one, known)[1]
        kinds.append(f"P({kind.split(' * ')[0]})" if " * " in kind else kind)  # an array comes as a pointer
    return kinds


def enum_values(body, constants):
    values, following = [], 0
    for entry in body.split(","):
        if not entry.strip():
            continue
        name, _, number = (part.strip() for part in entry.partition("="))
        following = constants[number] if number in constants else int(number, 0) if number else following
        values.append((name, following))
        following += 1
    return values


def read_statement(text, out, known, previous):
    """Adds one statement to out; gives the name of an integer typedef, whose enum may follow."""
    if match := re.fullmatch(r"typedef struct (\w+) (\w+)", text):
        out.opaque.append(match[2])
        known.add(match[2])
    elif match := re.fullmatch(r"typedef struct (\w+) \{(.*)\} (\w+)", text):
        out.structs[match[3]] = fields_of(match[2], known)
        known.add(match[3])
    elif match := re.fullmatch(r"enum \{(.*)\}", text):
        if not previous:
            raise HeaderError(f"an enum without a typedef before it: {text[:80]!r}")
        out.enums[previous] = enum_values(match[1], out.constants)
    elif match := re.fullmatch(r"typedef (.+?) ?\( ?\* ?(\w+) ?\) ?\((.*)\)", text):
        out.callbacks[match[2]] = (type_of(match[1], known), arguments_of(match[3], known))
        known.add(match[2])
    elif match := re.fullmatch(r"typedef (\w+) (\w+)", text):
        out.enums[match[2]] = []
        SCALARS[match[2]] = type_of(match[1], known)
        return match[2]
    elif match := re.fullmatch(r"FOCAL_API (.+?[ *])(\w+) ?\((.*)\)", text):
        out.functions[match[2]] = (type_of(match[1], known), arguments_of(match[3], known))
    else:
        raise HeaderError(f"cannot read {text[:120]!r}")
    return None


def parse(header_text):
    out, known, previous = Declarations(), set(), None
    text, out.constants = split_directives(without_comments(header_text))
    for statement in statements(text):
        previous = read_statement(statement, out, known, previous)
    for name in ("FOCAL_VERSION_MAJOR", "FOCAL_VERSION_MINOR", "FOCAL_VERSION_PATCH"):
        if name not in out.constants:
            raise HeaderError(f"the header does not define {name}")
    return out


def class_name(typedef):
    """focal_landmark_status -> LandmarkStatus"""
    return "".join(word.capitalize() for word in typedef.split("_")[1:])


def member_names(values):
    """Without the words they all begin with: FOCAL_QUALITY_BEST -> BEST; FOCAL_ERROR_IO beside FOCAL_OK -> IO."""
    words = [name.split("_") for name, _ in values]
    shared = 0
    while all(len(one) > shared + 1 and one[shared] == words[0][shared] for one in words):
        shared += 1
    for one, (_, number) in zip(words, values):
        yield "_".join(one[shared:]).removeprefix("ERROR_"), number


def listing(opening, items, closing):
    """'opening a, b closing', broken into lines that fit."""
    line = opening + ", ".join(items) + closing
    if len(line) <= WIDTH:
        return [line]
    lines, line = [opening.rstrip()], "        "
    for item in items:
        if len(line) + len(item) + len(closing) > WIDTH:
            lines.append(line.rstrip())
            line = "        "
        line += item + ", "
    return lines + [line.rstrip().rstrip(",") + closing]


def write_types(out):
    lines = []
    for name, number in out.constants.items():
        lines.append(f"{name} = {number if number < 1000 else hex(number)}")
    for typedef, values in out.enums.items():
        lines += ["", "", f"class {class_name(typedef)}(IntEnum):", f'    """{typedef}"""']
        lines += [f"    {name} = {number}" for name, number in member_names(values)]
    lines += ["", "", "# Handles: tags to hand back, never followed."]
    lines += [f'{name} = type("{name}", (Structure,), {{}})' for name in out.opaque]
    lines += ["", "# Callbacks."]
    for name, (result, arguments) in out.callbacks.items():
        lines += listing(f"{name} = CFUNCTYPE(", [result] + arguments, ")")
    for name, fields in out.structs.items():
        lines += ["", "", f"class {name}(Structure):", "    _fields_ = ["]
        lines += [f'        ("{field}", {kind}),' for field, kind in fields] + ["    ]"]
    return lines


def write_functions(out):
    lines = ["", "", "# name: (result, arguments)", "FUNCTIONS = {"]
    for name, (result, arguments) in out.functions.items():
        lines += listing(f'    "{name}": ({result}, [', arguments, "]),")
    return lines + ["}", ""]


def generate(header_text):
    out = parse(header_text)
    body = write_types(out) + write_functions(out)
    names = ["CFUNCTYPE", "Structure"] + sorted(set(re.findall(r"\bc_\w+", "\n".join(body))))
    head = ['"""The declarations of focal.h for ctypes. Made by generate_abi.py: change the header, run it again."""']
    head += listing("from ctypes import (", names, ")")
    head += ["from ctypes import POINTER as P", "from enum import IntEnum", ""]
    return "\n".join(head + body)


def main():
    parser = argparse.ArgumentParser(description="Writes focal/_abi.py from focal.h")
    parser.add_argument("--check", action="store_true", help="write nothing; fail when the file is stale")
    parser.add_argument("header", nargs="?", type=pathlib.Path, default=HEADER)
    parser.add_argument("out", nargs="?", type=pathlib.Path, default=OUT)
    given = parser.parse_args()
    try:
        text = generate(given.header.read_text(encoding="utf-8"))
    except HeaderError as error:
        sys.exit(f"{given.header.name}: {error}")
    if not given.check:
        given.out.write_text(text, encoding="utf-8")
    elif not given.out.exists() or given.out.read_text(encoding="utf-8") != text:
        sys.exit(f"{given.out.name} is not what {given.header.name} gives: run bindings/python/generate_abi.py")


if __name__ == "__main__":
    main()
