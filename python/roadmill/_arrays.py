"""Arrays of an `.npz` file as views of the file in memory."""

from __future__ import annotations

import mmap
import pathlib
import zipfile
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

Arrays = dict[str, npt.NDArray[Any]]


def mapped(file: pathlib.Path) -> Arrays:
    """The arrays of an `.npz` file that roadmill exported, by name: read-only views of the mapped file.

    Nothing is copied, so that arrays larger than the memory can be opened; the system reads what is looked at. The file may be
    removed once it is mapped. Members are neither packed nor encrypted, and their data begin at multiples of 64 bytes.
    """
    arrays: Arrays = {}
    with open(file, "rb") as opened, zipfile.ZipFile(opened) as archive:
        view = mmap.mmap(opened.fileno(), 0, access=mmap.ACCESS_READ)
        for member in archive.infolist():
            # The local header: 30 bytes, of which the last four give the lengths of the name and of what follows it.
            opened.seek(member.header_offset + 26)
            lengths = [int.from_bytes(opened.read(2), "little") for _ in range(2)]
            opened.seek(member.header_offset + 30 + sum(lengths))
            np.lib.format.read_magic(opened)
            shape, is_fortran, dtype = np.lib.format.read_array_header_1_0(opened)
            order: Literal["F", "C"] = "F" if is_fortran else "C"
            array: npt.NDArray[Any] = np.ndarray(shape, dtype, view, opened.tell(), order=order)
            arrays[member.filename.removesuffix(".npy")] = array
    return arrays
