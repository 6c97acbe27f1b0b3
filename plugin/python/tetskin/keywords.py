# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Says in a sentence what is wrong with the names of a call's arguments; used by the extension module."""
from __future__ import annotations

import ast
import difflib
import inspect
from typing import Sequence

def _signature_of(text: str) -> inspect.Signature:
    """The signature in a function's heading, as nanobind writes it."""
    heading = text.split(" -> ")[0].replace("\\", "_").rstrip(":")
    defined = ast.parse(heading + ": ...").body[0]
    assert isinstance(defined, ast.FunctionDef)
    given = defined.args
    kinds = inspect.Parameter
    positional = [*given.posonlyargs, *given.args]
    first_default = len(positional) - len(given.defaults)
    parameters = [
        kinds(one.arg, kinds.POSITIONAL_OR_KEYWORD, default=None if index >= first_default else kinds.empty)
        for index, one in enumerate(positional)
    ]
    if given.vararg:
        parameters.append(kinds(given.vararg.arg, kinds.VAR_POSITIONAL))
    for one, default in zip(given.kwonlyargs, given.kw_defaults):
        parameters.append(kinds(one.arg, kinds.KEYWORD_ONLY, default=None if default else kinds.empty))
    return inspect.Signature(parameters)


def _fault_of(signature: inspect.Signature, positional: int, names: Sequence[str]) -> str | None:
    known = [name for name in signature.parameters if name != "self"]
    for name in names:
        if name not in known:
            near = difflib.get_close_matches(name, known, 1)
            advice = f"did you mean {near[0]!r}?" if near else f"there are: {', '.join(known) or 'none'}"
            return f"got an unexpected keyword argument {name!r}; {advice}"
    try:
        signature.bind(*[None] * positional, **dict.fromkeys(names))
        return None
    except TypeError as error:
        said = str(error)
    alone = [name for name in known if signature.parameters[name].kind is inspect.Parameter.KEYWORD_ONLY]
    if said.startswith("too many positional") and alone:
        said += f"; by their names alone: {', '.join(alone)}"
    return said


def fault(name: str, signatures: Sequence[Sequence[str]], positional: int, names: Sequence[str]) -> str | None:
    """What is wrong with this number of positional arguments and these names; None if they fit a signature.

    signatures: nanobind's, one for each overload, each with its heading first.
    """
    said = None
    for heading, *_ in signatures:
        said = _fault_of(_signature_of(heading), positional, names)
        if said is None:
            return None
    return f"{name.replace('.__init__', '')}() {said}"
