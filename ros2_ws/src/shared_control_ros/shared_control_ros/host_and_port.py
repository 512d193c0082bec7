"""Addresses on command lines."""

import argparse


def host_and_port(text: str) -> tuple[str, int]:
    """``HOST:PORT``, for ``argparse``."""
    host, _, port = text.rpartition(':')
    if not host or not port.isdecimal():
        raise argparse.ArgumentTypeError(f'expected HOST:PORT, got {text!r}')
    return host.strip('[]'), int(port)
