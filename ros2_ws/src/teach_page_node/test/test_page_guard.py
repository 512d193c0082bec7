"""Who is let in."""

import pytest
from starlette.applications import Starlette
from starlette.responses import PlainTextResponse
from starlette.routing import Route, WebSocketRoute
from starlette.testclient import TestClient
from starlette.websockets import WebSocketDisconnect
from teach_page_node.guard import COOKIE, Guard


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


@pytest.mark.parametrize('host', ['evil.example', '127.0.0.1.evil.example:8088', ''])
def test_another_name_for_this_machine_is_refused(visit, host):
    assert visit().get('/', headers={'host': host}).status_code == 403


@pytest.mark.parametrize('origin', ['http://evil.example', 'http://127.0.0.1:9000', 'null'])
def test_other_pages_may_not_speak_to_it(visit, origin):
    assert visit().get('/', headers={'origin': origin}).status_code == 403
    with pytest.raises(WebSocketDisconnect), visit().websocket_connect('/live', headers={'origin': origin}):
        pass


def test_an_open_page_wants_its_token_once(visit):
    client = visit('secret', 'laptop:8088')
    assert client.get('/').status_code == 403
    assert client.get('/?token=wrong').status_code == 403
    with pytest.raises(WebSocketDisconnect), client.websocket_connect('/live'):
        pass
    assert client.get('/?token=secret').text == 'the page'
    assert client.cookies[COOKIE] == 'secret'
    assert client.get('/').text == 'the page'
    with client.websocket_connect('ws://laptop:8088/live', headers={'cookie': f'{COOKIE}=secret'}) as socket:
        assert socket.receive_text() == 'a picture'
