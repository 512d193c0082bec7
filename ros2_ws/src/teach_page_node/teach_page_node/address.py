"""Where the page is, and the token that lets people in. Light: who starts the node takes the address from here."""

import socket

LOOPBACK = ('127.0.0.1', 'localhost', '::1')
TOKEN_VARIABLE = 'SHARED_CONTROL_PAGE_TOKEN'
"""Environment variable with the token, for who starts the node and tells the address: parameters are recorded."""


def needs_token(host: str) -> bool:
    """Whether a page that listens on ``host`` is open to the network."""
    return host not in LOOPBACK


def listen(host: str, port: int) -> socket.socket:
    """A socket at which the page can be served.

    Raises:
        OSError: the address cannot be had; the message names it.
    """
    family = socket.AF_INET6 if ':' in host else socket.AF_INET
    try:
        return socket.create_server((host, port), family=family)
    except OSError as error:
        raise OSError(f'cannot serve the page at {host}:{port} ({error.strerror}): name another host or port, '
                      'port 0 for any that is free') from error


def free_port(host: str) -> int:
    """A port of ``host`` at which nobody listens.

    Raises:
        OSError: see :func:`listen`.
    """
    with listen(host, 0) as bound:
        return bound.getsockname()[1]


def page_address(host: str, port: int, token: str | None) -> str:
    """What to open in a browser.

    Args:
        host: on which the page listens; when that is all interfaces, the name of this machine is in the address.
        port: on which it listens.
        token: None when the page is for this machine only.
    """
    if host in ('0.0.0.0', '::'):
        host = socket.gethostname()
    name = f'[{host}]' if ':' in host else host
    return f'http://{name}:{port}/' + (f'?token={token}' if token else '')
