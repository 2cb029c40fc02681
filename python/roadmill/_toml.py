"""Values as TOML."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any

import numpy as np


def document(table: Mapping[str, Any]) -> str:
    """A TOML document with these keys; tables stand in one line each. What is None is left out."""
    return "".join(f"{_key(name)} = {value(it)}\n" for name, it in table.items() if it is not None)


def value(it: Any) -> str:
    """A value: numbers, texts, paths, sequences and arrays of them, tables (mappings)."""
    if isinstance(it, bool | np.bool_):
        return "true" if it else "false"
    if isinstance(it, int | np.integer):
        return str(int(it))
    if isinstance(it, float | np.floating):
        # The shortest text that is read back as the same number; TOML asks for a point or an exponent.
        return repr(float(it))
    if isinstance(it, str):
        return _text(it)
    if isinstance(it, os.PathLike):
        return _text(os.fspath(it))
    if isinstance(it, Mapping):
        inner = ", ".join(f"{_key(name)} = {value(each)}" for name, each in it.items() if each is not None)
        return f"{{ {inner} }}" if inner else "{}"
    if isinstance(it, np.ndarray):
        return value(it.tolist())
    if isinstance(it, list | tuple):
        return f"[{', '.join(value(each) for each in it)}]"
    raise TypeError(f"a {type(it).__name__} found; a number, text, path, sequence or mapping expected")


def _key(name: str) -> str:
    is_bare = name != "" and all(c.isascii() and (c.isalnum() or c in "-_") for c in name)
    return name if is_bare else _text(name)


def _text(text: str) -> str:
    # JSON's escapes are TOML's, but for this control character, which JSON leaves as it is.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
