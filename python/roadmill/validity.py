"""Validity by a function of one's own."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

__all__ = ["ValidityFunction"]


@dataclass(frozen=True)
class ValidityFunction:
    """A function that says which configurations are valid, beside the problem's own robot and obstacles: a configuration is valid
    if the model finds so and the function too.

    It needs a problem of bodies with `edges="sampled"`: a function judges single configurations, so that along edges and paths it is
    asked at steps, and nothing is proved of what lies between them. It is called in threads of this process, with Python's lock.
    """

    identity: str
    """What the function is known by, at most 200 bytes. It enters the problem's digest and the run folder, which cannot hold
    the function: give another one whenever the function comes to give other answers."""
    function: Callable[[npt.NDArray[np.float64]], bool]
    """Is given a configuration as a read-only array of shape (dofs,), which the model finds valid, and says whether it is valid
    (a `bool`). Values are in the order of `Roadmap.dof_names` and in the units of `Roadmap.dof_units`: lengths in the problem's
    unit, angles in radians, rotations as unit quaternions w x y z, of either sign. The answer depends on the configuration
    alone: about some configurations the function is asked twice, and a `RuntimeError` says so if the answers differ. An
    exception ends what is under way and goes on to the caller as it is."""

    def for_core(self) -> tuple[str, Callable[[bytes], bool]]:
        """What `roadmill._core` is given: the identity, and the function of a configuration's bytes."""
        return self.identity, self._ask

    def _ask(self, configuration: bytes) -> bool:
        answer = self.function(np.frombuffer(configuration, dtype="<f8"))
        if isinstance(answer, bool | np.bool_):
            return bool(answer)
        found = type(answer).__name__
        raise TypeError(f"the validity function {self.identity!r} gave a {found}; a bool expected")
