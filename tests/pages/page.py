# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The contents of a Markdown page: commands, code in its sentences, headings and links."""
import re

FENCE = re.compile(r"^```(\w*)[^\n]*\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def prose(text):
    """The text without its blocks of code; line numbers stay the same."""
    return FENCE.sub(lambda block: "\n" * block.group().count("\n"), text)


def blocks(text):
    """(language, text) of each block of code."""
    return FENCE.findall(text)


def commands_of(script):
    """The commands of a shell script, with continued lines joined and without comments."""
    lines = re.sub(r"\\\n\s*", "", script).splitlines()
    lines = [re.sub(r"(^|\s)#.*", "", line).strip() for line in lines]
    return [line for line in lines if line]


def commands(text):
    """The commands in the page's blocks of sh, in order."""
    return [command for language, block in blocks(text) if language == "sh" for command in commands_of(block)]


def passages(text):
    """Paragraphs, items of lists and rows of tables: words within one of these belong together."""
    parts = re.split(r"\n\s*\n|\n(?=\s*(?:- |\d+\. |\|))", prose(text))
    return [" ".join(part.split()) for part in parts if part.strip()]


def code(passage):
    """The texts between backquotes."""
    return re.findall(r"`([^`]+)`", passage.replace(r"\|", "|"))


def anchors(text):
    """The anchors of the page's headings, as GitHub forms them."""
    found = set()
    for heading in re.findall(r"^#+ +(.*?) *$", prose(text), re.MULTILINE):
        words = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading).lower()
        base = anchor = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
        count = 0
        while anchor in found:
            count += 1
            anchor = f"{base}-{count}"
        found.add(anchor)
    return found


def links(text):
    """Targets of links and pictures, also of those in HTML tags, with their line numbers."""
    found = []
    for number, line in enumerate(re.sub(r"`[^`\n]*`", "", prose(text)).splitlines(), 1):
        found += [(number, target) for target in re.findall(r"\]\(([^)\s]+)\)", line)]
        for name, value in re.findall(r"""\s(src|srcset|href)=["']([^"']*)["']""", " " + line):
            choices = value.split(",") if name == "srcset" else [value]
            found += [(number, choice.split()[0]) for choice in choices if choice.strip()]
    return found
