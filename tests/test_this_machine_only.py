"""Nodes listen on the loopback interface alone, unless somebody opens the graph."""

import ipaddress
import os
import re
import socket
import struct
import subprocess
import sys
from pathlib import Path

import pytest
from shared_control.processes import leave_with_the_parent

DDS_VARIABLES = ('ROS_AUTOMATIC_DISCOVERY_RANGE', 'FASTRTPS_DEFAULT_PROFILES_FILE')


def udp_addresses(pid):
    """IPv4 addresses on which a process' UDP sockets are bound."""
    links = [os.readlink(link) for link in Path(f'/proc/{pid}/fd').iterdir()]
    sockets = {match.group(1) for link in links if (match := re.fullmatch(r'socket:\[(\d+)\]', link))}
    rows = [line.split() for line in Path(f'/proc/{pid}/net/udp').read_text().splitlines()[1:]]
    return {ipaddress.ip_address(socket.inet_ntoa(struct.pack('=I', int(row[1].split(':')[0], 16))))
            for row in rows if row[9] in sockets}


@pytest.mark.parametrize('opened', [False, True])
def test_a_node_started_by_hand(domain_id, opened):
    environment = {name: value for name, value in os.environ.items() if name not in DDS_VARIABLES}
    if opened:
        environment['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'SUBNET'
    node = subprocess.Popen([Path(sys.executable).parent / 'torque_ctrl_node'], env=environment, text=True,
                            stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, preexec_fn=leave_with_the_parent)
    with node, node.stderr:
        assert any('ready' in line for line in node.stderr)
        addresses = udp_addresses(node.pid)
        node.terminate()
    assert addresses
    assert all(address.is_loopback or address.is_multicast for address in addresses) is not opened
