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

"""Who is let in."""

import pytest
from starlette.applications import Starlette
from starlette.responses import PlainTextResponse
from starlette.routing import Route, WebSocketRoute
from starlette.testclient import TestClient
from starlette.websockets import WebSocketDisconnect
from teach_page_node import address
from teach_page_node.address import own_token
from teach_page_node.guard import Guard


async def _page(_):
    return PlainTextResponse('the page')


async def _live(websocket):
    await websocket.accept()
    await websocket.send_text('a picture')
    await websocket.close()


@pytest.fixture
def visit():
    """``visit(token, host)``: a client of a guarded application that calls the server ``host``."""
    app = Starlette(routes=[Route('/', _page), WebSocketRoute('/live', _live)])
    return lambda token=None, host='127.0.0.1:8088': TestClient(Guard(app, token), base_url=f'http://{host}')


@pytest.mark.parametrize('host', ['127.0.0.1:8088', 'localhost:8088', '[::1]:8088'])
def test_this_machine_is_let_in(visit, host):
    assert visit(host=host).get('/').text == 'the page'
    with visit(host=host).websocket_connect(f'ws://{host}/live', headers={'origin': f'http://{host}'}) as socket:
        assert socket.receive_text() == 'a picture'


@pytest.mark.parametrize('host', ['evil.example', '127.0.0.1.evil.example:8088', '', '[', '[::1', ']'])
def test_another_name_for_this_machine_is_refused(visit, host):
    assert visit().get('/', headers={'host': host}).status_code == 403


@pytest.mark.parametrize('origin', ['http://evil.example', 'http://127.0.0.1:9000', 'null', '', 'http://['])
def test_other_pages_may_not_speak_to_it(visit, origin):
    assert visit().get('/', headers={'origin': origin}).status_code == 403
    with pytest.raises(WebSocketDisconnect), visit().websocket_connect('/live', headers={'origin': origin}):
        pass


@pytest.mark.parametrize('token', [None, 'secret'])
def test_other_pages_may_not_show_it_in_a_frame(visit, token):
    for path in ('/', '/?token=secret'):
        answer = visit(token).get(path, headers={'sec-fetch-dest': 'iframe'})
        if answer.status_code == 200:
            assert answer.headers['content-security-policy'] == "frame-ancestors 'self'"
            assert answer.headers['x-frame-options'] == 'SAMEORIGIN'


def test_an_open_page_wants_its_token_once(visit):
    client = visit('secret', 'laptop:8088')
    assert client.get('/').status_code == 403
    assert client.get('/?token=wrong').status_code == 403
    with pytest.raises(WebSocketDisconnect), client.websocket_connect('/live'):
        pass
    assert client.get('/?token=secret').text == 'the page'
    (name, value), = client.cookies.items()
    assert value == 'secret'
    assert client.get('/').text == 'the page'
    with client.websocket_connect('ws://laptop:8088/live', headers={'cookie': f'{name}={value}'}) as socket:
        assert socket.receive_text() == 'a picture'


def test_two_servers_of_a_host_leave_each_other_their_cookies(visit):
    """A browser keeps cookies by host, whatever the port."""
    first, second = visit('secret', 'laptop:8088'), visit('another', 'laptop:8089')
    first.get('/?token=secret')
    second.cookies.update(first.cookies)
    assert second.get('/').status_code == 403
    assert second.get('/?token=another').status_code == 200
    first.cookies.update(second.cookies)
    assert len(first.cookies) == 2
    assert first.get('/').status_code == second.get('/').status_code == 200


@pytest.mark.parametrize('foreign', [
    'prefs={"theme":"dark"}', 'a[0]=1', 'user=Jörg', 'a=b c', 'x', 'secure', 'path=1', '', 'teach_page_=x'])
@pytest.mark.parametrize('order', ['{foreign}; {own}', '{own}; {foreign}', '{foreign};{own};{foreign}'])
def test_a_cookie_of_another_program_of_the_host_locks_nobody_out(visit, foreign, order):
    first = visit('secret', 'laptop:8088')
    first.get('/?token=secret')
    (name, value), = first.cookies.items()
    cookies = order.format(foreign=foreign, own=f'{name}={value}').encode()
    assert visit('secret', 'laptop:8088').get('/', headers={'cookie': cookies}).text == 'the page'
    wrong = order.format(foreign=foreign, own=f'{name}=guessed').encode()
    assert visit('secret', 'laptop:8088').get('/', headers={'cookie': wrong}).status_code == 403


class TestOwnToken:
    """The token of a node that is given none."""

    @pytest.fixture(autouse=True)
    def home(self, tmp_path, monkeypatch):
        monkeypatch.setenv('ROS_HOME', str(tmp_path / 'ros'))
        self.starter = '1 1'
        monkeypatch.setattr(address, 'starter', lambda: self.starter)
        return tmp_path / 'ros'

    def test_stays_the_same_for_whoever_starts_the_node_again(self):
        token = own_token(8088)
        assert len(token) >= 20 and token == own_token(8088)

    def test_is_another_for_another_start_or_port(self):
        token = own_token(8088)
        assert own_token(8089) != token
        self.starter = '1 2'
        assert own_token(8088) != token

    def test_cannot_be_guessed_by_other_users(self, home):
        own_token(8088)
        assert (home / 'shared_control' / 'page_secret').stat().st_mode & 0o077 == 0

    def test_is_made_anew_where_nothing_can_be_kept(self, home):
        home.write_text('a file')
        assert len(own_token(8088)) >= 20 and own_token(8088) != own_token(8088)
