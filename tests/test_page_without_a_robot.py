"""The page of a node alone: keyboards of all kinds, and a browser that cannot draw in 3D."""

import re

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from shared_control.keys import has_let_go
from shared_control_ros import contract
from shared_control_testing.page import Browser
from std_msgs.msg import String

ARROW_RIGHT = {'key': 'ArrowRight', 'code': 'ArrowRight', 'windowsVirtualKeyCode': 39}


@pytest.fixture(scope='class')
def address(start_node):
    node = start_node('teach_page_node', port=0)
    node.wait_for_log('open http')
    return re.search(r'open (http://[^\s\x1b]+)', node.log())[1]


@pytest.fixture(scope='class')
def browser(address):
    browser = Browser(webgl=False)
    browser.driver.get(address)
    browser.wait(lambda: browser.text('role') == 'you teach', 'the seat')
    yield browser
    browser.close()


class TestTheKeyboard:
    """Keys as browsers report them."""

    @pytest.fixture
    def press(self, browser):
        """``press(kind, **key)``: a key event as the browser gets it from the system."""
        return lambda kind, **key: browser.driver.execute_cdp_cmd('Input.dispatchKeyEvent', {'type': kind, **key})

    @staticmethod
    def is_down(browser, name):
        return browser.script(f'return document.querySelector(\'[data-key="{name}"]\').classList.contains("down")')

    def test_without_webgl_it_says_so_and_goes_on(self, browser):
        assert 'cannot draw in 3D' in browser.text('scene')
        assert browser.text('doing') == 'Waiting for the robot …'
        assert browser.barriers() == [] == browser.nameless()

    def test_it_shows_what_is_waited_for_and_a_pause_whoever_asked_for_it(self, browser, observer):
        waiting, reports = observer.publisher(contract.WAITING), observer.publisher(contract.DIAGNOSTICS)
        observer.spin(lambda: waiting.get_subscription_count() and reports.get_subscription_count(), what='the page')

        def report(paused):
            reports.publish(DiagnosticArray(status=[DiagnosticStatus(values=[KeyValue(key='paused', value=paused)])]))
        waiting.publish(String(data='for panda_sim_node to start since 14:00 (7 s)'))
        browser.wait(lambda: browser.text('doing') == 'Waiting for panda_sim_node to start since 14:00 (7 s)', 'why')
        waiting.publish(String())
        report('True')
        browser.wait(lambda: browser.text('pause-text') == 'Go on', 'the pause')
        assert browser.text('doing') == 'Paused: everything waits, and keys do not count.'
        report('False')
        browser.wait(lambda: browser.text('pause-text') == 'Pause', 'going on')

    @pytest.mark.parametrize(('name', 'key'), [
        ('left', {'key': 'a', 'code': 'KeyQ', 'windowsVirtualKeyCode': 65}),  # a French keyboard
        ('right', {'key': 'd', 'code': 'KeyH', 'windowsVirtualKeyCode': 68}),  # Dvorak
        ('left', {'key': 'ф', 'code': 'KeyA', 'windowsVirtualKeyCode': 65}),  # a Russian one
        ('left', {'key': 'A', 'code': 'KeyA', 'windowsVirtualKeyCode': 65}),
        ('left', {'key': 'ArrowLeft', 'windowsVirtualKeyCode': 37}),  # a remote desktop
        ('right', {'key': 'ArrowRight', 'code': 'Numpad6', 'windowsVirtualKeyCode': 39}),
        ('space', {'key': ' ', 'code': 'Space', 'windowsVirtualKeyCode': 32})])
    def test_keys_count_by_what_they_mean(self, browser, press, name, key):
        press('rawKeyDown', **key)
        assert self.is_down(browser, name)
        press('keyUp', **key)
        assert not self.is_down(browser, name)

    @pytest.mark.parametrize('key', [
        {'key': 'q', 'code': 'KeyA', 'windowsVirtualKeyCode': 81}, {'key': '4', 'code': 'Numpad4'}])
    def test_other_keys_mean_nothing(self, browser, press, key):
        press('rawKeyDown', **key)
        assert not any(self.is_down(browser, name) for name in ('left', 'space', 'right'))
        press('keyUp', **key)

    def test_a_lost_release_does_not_make_a_key_dead(self, browser, press):
        browser.script('window.sent = []; const send = WebSocket.prototype.send;'
                       'WebSocket.prototype.send = function (text) { window.sent.push(text); send.call(this, text); }')
        press('rawKeyDown', **ARROW_RIGHT)
        press('rawKeyDown', **ARROW_RIGHT)
        sent = [text for text in browser.script('return window.sent') if 'keys' in text]
        down = ['[0,1,0]' in text for text in sent]
        assert sum(now and not before for before, now in zip([False, *down], down, strict=False)) == 2
        press('keyUp', **ARROW_RIGHT)

    def test_without_the_focus_it_lets_go_and_presses_nothing(self, browser, press, observer):
        joys = observer.listen(contract.KEYS)
        press('rawKeyDown', **ARROW_RIGHT)
        observer.spin(lambda: joys and list(joys[-1].buttons) == [0, 1, 0], what='the key')
        joys.clear()
        browser.script('window.dispatchEvent(new Event("blur"))')
        observer.spin(lambda: joys and has_let_go(joys[-1].axes, joys[-1].buttons), what='an empty state')
        assert {tuple(joy.buttons) for joy in joys} <= {(0, 1, 0), ()}
        browser.script('window.dispatchEvent(new Event("focus"))')

    def test_a_part_that_fails_takes_no_other_with_it(self, browser):
        browser.script("document.querySelector('[data-part=tilt]').remove()")
        pictures = browser.script('return teachPage.pictures')
        browser.wait(lambda: browser.script('return teachPage.pictures') > pictures + 5, 'more pictures')
        assert browser.text('role') == 'you teach'


@pytest.fixture(scope='class')
def holds(observer):
    """``holds(left, up)``: wait until the page's stick is there, to within a pixel."""
    joys = observer.listen(contract.KEYS)

    def wait_for(left, up):
        joys.clear()
        observer.spin(lambda: joys and list(joys[-1].axes) == pytest.approx([left, up], abs=0.02),
                      what=f'axes {left}, {up} (now {joys[-1].axes if joys else None})')
    return wait_for


class TestTheDrawing:
    """Pulled by a finger or by the mouse, as far as it is held."""

    @staticmethod
    def shows_ring(browser):
        return browser.script('return document.querySelector(".ring").classList.contains("shown")')

    def test_by_a_finger(self, browser, holds):
        x, y = browser.script('const b = document.querySelector(".close-view .drawing").getBoundingClientRect();'
                              'return [b.x + b.width / 2, b.y + b.height / 2]')

        def touch(kind, *points):
            browser.driver.execute_cdp_cmd('Input.dispatchTouchEvent', {
                'type': kind, 'touchPoints': [{'x': x + dx, 'y': y + dy} for dx, dy in points]})
        touch('touchStart', (0, 0))
        touch('touchMove', (-40, 0))
        holds(0.5, 0.0)
        assert self.shows_ring(browser)
        touch('touchMove', (200, 0))
        holds(-1.0, 0.0)
        touch('touchEnd')
        holds(0.0, 0.0)
        assert not self.shows_ring(browser)

    def test_by_the_mouse(self, browser, holds):
        drawing = browser.driver.find_element('css selector', '.close-view .drawing')
        browser.keys().click_and_hold(drawing).move_by_offset(40, 0).perform()
        holds(-0.5, 0.0)
        browser.keys().move_by_offset(-80, -40).perform()
        holds(0.5, 0.5)
        browser.keys().release().perform()
        holds(0.0, 0.0)
