#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""comments.py: checks what comments in headers and sources say about the code below them:

- each line `/// name  meaning` is about a parameter, or a member, of the declaration below
- each constant of the library has a comment: its reason, or what breaks without it
- no comment is empty, and none contains a table or a sentence that a reflow of the lines has run together or torn

First it checks that it finds such faults where they are planted."""
import pathlib
import re
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[2]
LIBRARY = SOURCE / "plugin" / "tetskin"
COLUMNS = 120

ROW = re.compile(r"/// ([a-z]\w*(?:, [a-z]\w*)*)  +\S")  # of a table: names, two blanks or more, a meaning
FACT = re.compile(r"/// [A-Z][a-z]+  +\S")  # "Cost  ...", "Errors  ..."
CONSTANT = re.compile(r"^\s*(?:inline |static |constexpr |const )+[\w:<>, ]*\b(k[A-Z]\w*)\s*(?:\[\w*\]\s*)*(?:=|\{|;)")
WORD = re.compile(r"[A-Za-z_]\w*")


def without_nested(text, opening, closing):
    """The text without what stands in brackets."""
    depth, kept = 0, []
    for character in text:
        depth += character in opening
        if depth == 0:
            kept.append(character)
        depth -= character in closing
    return "".join(kept)


def end_of(text, start, opening, closing):
    """The place behind the bracket that closes the one at `start`."""
    depth = 0
    for place in range(start, len(text)):
        depth += text[place] == opening
        depth -= text[place] == closing
        if depth == 0:
            return place + 1
    return len(text)


def names_in_list(text):
    """The names of a parameter list, by its text between the brackets."""
    names = set()
    for parameter in without_nested(text, "<([{", ">)]}").split(","):
        words = WORD.findall(parameter.split("=")[0])
        if words:
            names.add(words[-1])
    return names


def names_declared(text):
    """The names that a comment above this text may explain: the parameters of a function, also of a template; the
    members of a type."""
    names = set()
    template = re.match(r"\s*template\s*<", text)
    if template:
        end = end_of(text, template.end() - 1, "<", ">")
        names |= names_in_list(text[template.end():end - 1])
        text = text[end:]
    if re.match(r"\s*(class|struct|union|enum)\b", text):
        end = end_of(text, text.find("{"), "{", "}")
        return names | set(WORD.findall(text[:end]))
    alias = re.match(r"\s*using\s+\w+\s*=([^;]*);", text)  # the type of a callable
    opening = text.find("(")
    while opening >= 0 and re.search(r"operator\s*$", text[:opening]):
        opening = text.find("(", opening + 1)
    if alias:
        opening = text.find("(")
    if opening < 0 or (text.find(";") >= 0 and text.find(";") < opening):
        return names
    return names | names_in_list(text[opening + 1:end_of(text, opening, "(", ")") - 1])


def blocks_of(lines):
    """The comments of several lines that begin with `///`: the number of the first line, and the number behind."""
    first = None
    for number, line in enumerate(lines + [""]):
        if line.lstrip().startswith("///") and not line.lstrip().startswith("///<"):
            first = number if first is None else first
        elif first is not None:
            yield first, number
            first = None


def faults_of_tables(lines):
    for first, behind in blocks_of(lines):
        below = "\n".join(lines[behind:behind + 400])
        below = re.sub(r"/\*(\w+)\*/", r"\1", below)  # parameters that are only named
        below = re.sub(r"//[^\n]*", "", below)
        declared = None
        for number in range(first, behind):
            row = ROW.match(lines[number].strip())
            if row:
                declared = names_declared(below) if declared is None else declared
                for name in row.group(1).split(", "):
                    if name not in declared:
                        yield number, f"explains '{name}', which the declaration below does not have"


def faults_of_lines(lines):
    for number, line in enumerate(lines):
        text = line.strip()
        if re.search(r"///?<?$", text):
            if not text.startswith("//") or text.startswith("///<"):
                yield number, "an empty comment"
        if text.startswith("/// ") and not ROW.match(text) and not FACT.match(text):
            if re.match(r"/// [^\s-].*[a-z.,;:)]  +\S", text):
                yield number, "a table that was run together"
        if number + 1 < len(lines) and torn(line, lines[number + 1]):
            yield number, "a sentence that was torn"


def torn(line, below):
    """Whether a line of prose ends early, and the next one continues its sentence."""
    same = re.match(r"(\s*///? )(?=\S)", line)
    if not same or not below.startswith(same.group(1)):
        return False
    text, rest = line[same.end():], below[same.end():]
    if len(text.split()) > 4 and not re.search(r"[A-Za-z]$", text):
        return False
    first = rest.split(" ")[0]
    if not re.match(r"[a-z(`]", first) or ROW.match(rest) or "  " in text or "  " in rest:
        return False
    return len(line) + 1 + len(first) <= COLUMNS - 12


def faults_of_constants(lines):
    """A comment stands above the constant, above others that stand directly above it, above the function that begins
    with it, or behind it. A constant computed only from other names needs none."""
    explained = False
    for number, line in enumerate(lines):
        constant = CONSTANT.match(line)
        if constant and "(" not in line.split(constant.group(1))[0]:
            value = " ".join(lines[number:number + 4]).split(constant.group(1))[1].split(";")[0]
            explained = "//" in line or is_explained(lines, number) or (explained and lines[number - 1].endswith(";"))
            if not explained and re.search(r"(?<![\w:])-?[0-9.]*[0-9]", value):
                yield number, f"the constant {constant.group(1)} without a comment"
        elif not line.startswith("    "):
            explained = False


def is_explained(lines, number):
    """Whether a comment stands above a line, or above the template or the function that begins with it."""
    above = number - 1
    while above > 0 and re.match(r"\s*template\s*<", lines[above]):
        above -= 1
    if lines[above].lstrip().startswith("//"):
        return True
    if not lines[above].endswith("{") or lines[above].startswith(("namespace", "class", "struct")):
        return False
    while above > 0 and re.match(r"\S", lines[above - 1]) and not lines[above - 1].startswith(("}", "//", "#")):
        above -= 1  # the function's lines
    return lines[above - 1].lstrip().startswith("//") or is_explained(lines, above)


def faults_in(lines, constants=True):
    for check in (faults_of_tables, faults_of_lines) + ((faults_of_constants,) if constants else ()):
        for number, said in check(lines):
            yield number + 1, said


PLANTED = (
    ("/// most  bound of the iterations\nvoid solve(int maximum, bool (*call)(int));\n", "explains 'most'"),
    ("/// maximum, most  bounds\ntemplate <class S>\nS solve(const std::map<int, int>& maximum = {});\n",
     "explains 'most'"),
    ("/// held  its frame does not move\nstruct Body {\n  bool pinned;\n};\n", "explains 'held'"),
    ("constexpr double kShare = 0.3;\n", "kShare"),
    ("/// A share.\nconstexpr double kShare = 0.3;\n\nvoid f() {\n  constexpr int kMost = 3;\n}\n", "kMost"),
    ("struct Point {\n  int count = 0;  ///<\n};\n", "empty"),
    ("/// Nothing is kept. embedding  of the mesh in the cage\nvoid add();\n", "run together"),
    ("// Velocities are the\n// chords of a rotation.\n", "torn"),
)
SOUND = """/// Solves.
/// maximum, call  bounds; and what is called
/// S              a scalar
/// Cost           O(n)
template <class S>
S solve(int maximum, const std::function<void(int)>& call = {});
/// first   of its nodes
struct Body {
  int first = 0;  ///< a node
};
/// T over D: at 0.1 it slips.
constexpr double kShare = 0.3;
constexpr double kOther = 0.1;
/// At most so many.
void f() {
  constexpr int kMost = 3;
}
"""


def check_itself():
    for text, wanted in PLANTED:
        said = [fault for _, fault in faults_in(text.split("\n"))]
        if len(said) != 1 or wanted not in said[0]:
            sys.exit(f"This check does not find what is planted in\n{text}but says {said}")
    if list(faults_in(SOUND.split("\n"))):
        sys.exit(f"This check finds faults in\n{SOUND}: {list(faults_in(SOUND.split(chr(10))))}")


def main():
    check_itself()
    folders = (LIBRARY, SOURCE / "demos", SOURCE / "tests")
    files = sorted(file for folder in folders for kind in ("*.h", "*.cpp") for file in folder.rglob(kind))
    if len(files) < 500:
        sys.exit(f"Only {len(files)} files found: look for them elsewhere")
    count = 0
    for file in files:
        for number, said in sorted(faults_in(file.read_text(encoding="utf-8").split("\n"), LIBRARY in file.parents)):
            print(f"{file.relative_to(SOURCE)}:{number}: {said}")
            count += 1
    print(f"{len(files)} files, {count} faults of comments")
    sys.exit(1 if count else 0)


if __name__ == "__main__":
    main()
