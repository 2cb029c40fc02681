"""What may go where: without TLS only if that is asked for."""

from __future__ import annotations

from collections.abc import Iterable

from ..errors import UsageError

# Protocols of Dask's that keep bytes secret and prove who is at the other end, or that never leave the process.
_SECURE = ("tls", "wss", "inproc")


def is_secure(address: str) -> bool:
    """Whether what goes to this address of Dask's (`tls://10.0.0.1:8786`) is encrypted and both ends are known."""
    return address.partition("://")[0] in _SECURE


def refuse_insecure(addresses: Iterable[str], insecure: bool) -> None:
    """Raises if one of the addresses is reached without TLS and that was not asked for.

    Raises:
        UsageError: It names the address.
    """
    for address in addresses:
        if not insecure and not is_secure(address):
            raise UsageError(
                f"{address} found, an address with TLS expected (a Dask cluster with `security=`): whoever reaches a port without "
                "TLS can run what they want there; `insecure=True` uses it all the same"
            )
