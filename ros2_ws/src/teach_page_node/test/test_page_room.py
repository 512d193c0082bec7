# Copyright 2026 shared-control maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""One teaches, the others watch; what pages say is checked."""

import pytest
from shared_control.tasks.balance import BALANCE
from starlette.applications import Starlette
from starlette.routing import WebSocketRoute
from starlette.testclient import TestClient
from teach_page_node.picture import Picture
from teach_page_node.room import Room


class Notebook:
    """A desk that notes what it is told."""

    is_replay = is_over = False
    task = BALANCE

    def __init__(self):
        self.notes = []

    def look(self):
        return Picture(pitch=0.1)

    def press(self, buttons, axes=()):
        self.notes.append((buttons, axes) if axes else buttons)

    def let_go(self):
        self.notes.append('let go')

    def do(self, command, value):
        if command == 'unknown':
            raise ValueError(command)
        self.notes.append((command, value))


@pytest.fixture
def desk():
    return Notebook()


@pytest.fixture
def client(desk):
    with TestClient(Starlette(routes=[WebSocketRoute('/live', Room(desk).receive)])) as client:
        yield client


def role(socket):
    """The next role that a page is told."""
    while 'role' not in (message := socket.receive_json()):
        pass
    return message['role']


def test_the_first_page_teaches_and_leaves_no_moment_behind(client, desk):
    with client.websocket_connect('/live') as first:
        assert role(first) == {'teaches': True, 'seat_is_free': False, 'watchers': 0}
        first.send_json({'keys': [1, 0, 0]})
        first.send_json({'keys': [0, 0, 0], 'axes': [0.5, 0]})
        with client.websocket_connect('/live') as second:
            assert not role(second)['teaches']
            second.send_json({'keys': [0, 1, 0]})
            second.send_json({'do': 'stop'})
            second.send_json({'do': 'take_seat'})
            first.send_json({'do': 'pause', 'value': None})
            first.close()
            assert role(second) == {'teaches': False, 'seat_is_free': True, 'watchers': 1}
            second.send_json({'do': 'take_seat'})
            assert role(second)['teaches']
    assert desk.notes == [[1, 0, 0], ([0, 0, 0], [0.5, 0.0]), ('pause', None), 'let go', 'let go']


def test_a_teacher_that_comes_back_has_the_seat_again(client, desk):
    with client.websocket_connect('/live?page=a') as first, client.websocket_connect('/live?page=b') as second:
        assert role(first)['teaches']
        assert not role(second)['teaches']
        with client.websocket_connect('/live?page=a') as again:  # the server does not know yet that the first is lost
            assert role(again) == {'teaches': True, 'seat_is_free': False, 'watchers': 2}
            first.send_json({'keys': [1, 0, 0]})
            again.send_json({'keys': [0, 1, 0]})
    assert desk.notes == ['let go', [0, 1, 0], 'let go']


def test_a_forgotten_page_that_was_there_first_keeps_the_seat_from_nobody(client, desk):
    """A tab of an earlier session connects again by itself, sooner than a person opens the new address."""
    with client.websocket_connect('/live?page=old') as old, client.websocket_connect('/live?page=new') as new:
        assert role(old)['teaches']
        assert role(new) == {'teaches': False, 'seat_is_free': True, 'watchers': 1}
        new.send_json({'do': 'take_seat'})
        assert role(new)['teaches']
        new.send_json({'keys': [1, 0, 0]})
        assert role(old) == {'teaches': True, 'seat_is_free': False, 'watchers': 1}  # when the other came
        while (told := role(old))['teaches'] or told['seat_is_free']:
            pass
        old.send_json({'keys': [0, 1, 0]})
        old.send_json({'do': 'take_seat'})
        new.send_json({'do': 'pause'})
    assert desk.notes == ['let go', [1, 0, 0], ('pause', None), 'let go']


@pytest.mark.parametrize('said', [
    'no json', '[]', '7', '{}', '{"keys": [1, 0]}', '{"keys": [1, 0, 2]}', '{"keys": [true, 0, 0]}', '{"keys": null}',
    '{"do": "unknown"}', '{"keys": [0, 0, 0], "axes": [0.5]}', '{"keys": [0, 0, 0], "axes": [NaN, 0]}',
    '{"keys": [0, 0, 0], "axes": [0, 1.5]}', '{"keys": [0, 0, 0], "axes": "ab"}',
    '{"keys": [0, 0, 0], "axes": [true, 0]}', b'', b'\xff\x00', b'no json', b'{"keys": [1, 0]}'])
def test_what_makes_no_sense_is_dropped(client, desk, said, caplog):
    with client.websocket_connect('/live') as page:
        role(page)
        (page.send_bytes if isinstance(said, bytes) else page.send_text)(said)
        page.send_json({'keys': [0, 0, 0]})
    assert desk.notes == [[0, 0, 0], 'let go']
    assert 'dropped a message' in caplog.text


def test_what_is_nested_without_end_ends_nothing(client, desk):
    with client.websocket_connect('/live') as page:
        assert role(page)['teaches']
        page.send_text(20_000 * '[')
        page.send_json({'do': 'pause'})
    assert ('pause', None) in desk.notes
