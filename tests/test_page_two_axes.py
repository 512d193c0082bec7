"""The teaching page of a task with two axes in a real browser, with a session on the live graph behind it."""

import itertools
import re

import pytest
from selenium.webdriver.common.keys import Keys
from shared_control_ros import contract
from shared_control_testing.page import Browser, served

pytestmark = pytest.mark.alone

ROLLED = 30
"""Pixels that no ball at rest moves."""


@pytest.fixture(scope='class')
def address(domain_id, tmp_path_factory):
    """``shared-control session --task detour --tutor page``, practising."""
    folder = tmp_path_factory.mktemp('session') / 'session'
    with served('session', '--task', 'detour', '--tutor', 'page', '--test-episodes', '0', '--output',
                str(folder)) as (_, address):
        yield address


@pytest.fixture(scope='class')
def browser(address):
    browser = Browser()
    browser.open(address)
    yield browser
    browser.close()


def ball(browser):
    """Where the ball is drawn, pixels."""
    box = browser.script('const b = document.querySelector("[data-part=close-ball]").getBoundingClientRect();'
                         'return [b.x, b.y]')
    return tuple(box)


def shown_moment(browser):
    """The human's moment as the page has it at one time: the text, and the angle of the arrow, deg."""
    text, turn = browser.script("""
        const part = (name) => document.querySelector(`[data-part=${name}]`);
        return [part("human-moment").textContent, part("arrow-human").getAttribute("transform")];""")
    return text, round(float(re.search(r'rotate\((\S+)\)', turn)[1]), 1)


@pytest.fixture(scope='class')
def holds(observer):
    """``holds(m_x, m_y)``: wait until M_h is that."""
    wrenches = observer.listen(contract.HUMAN_WRENCH)

    def wait_for(m_x, m_y):
        observer.spin(lambda: wrenches.clear() or observer.spin_for(0.03) or (
            wrenches and (wrenches[-1].wrench.torque.x, wrenches[-1].wrench.torque.y) == pytest.approx(
                (m_x, m_y), abs=1e-3)),
            what=f'M_h = {m_x}, {m_y}')

    return wait_for


PAD = """
window.pad = {index: 0, connected: true, mapping: "standard", axes: [0, 0, 0, 0],
              buttons: Array.from({length: 17}, () => ({pressed: false}))};
navigator.getGamepads = () => [null, window.pad];
"""


class TestTheDetourOnThePage:
    """In this order, in one session that practises."""

    def test_four_keys_roll_the_ball_to_where_they_point(self, browser, holds, observer):
        browser.wait(lambda: browser.text('phase') == 'Practice', 'practice')
        # After it was rolled to one side there is room to the other.
        for key, held, shown, angle, axis in (
                (Keys.ARROW_DOWN, (-5.0, 0.0), '↓5.0 0.0', 90.0, None),
                (Keys.ARROW_UP, (5.0, 0.0), '↑5.0 0.0', -90.0, 1),
                (Keys.ARROW_LEFT, (0.0, 5.0), '0.0 ←5.0', 180.0, None), ('d', (0.0, -5.0), '0.0 →5.0', 0.0, 0)):
            browser.type(Keys.SPACE)
            holds(0.0, 0.0)
            before = ball(browser)
            browser.type(key)
            holds(*held)
            browser.wait(lambda shown=shown, angle=angle: shown_moment(browser) == (shown, angle), f'{shown}, {angle}')
            if axis is None:
                observer.spin_for(1.5)
            else:
                sign = 1 if axis == 0 else -1
                browser.wait(lambda before=before, axis=axis, sign=sign: sign * (
                                 ball(browser)[axis] - before[axis]) > ROLLED,
                             f'the ball rolls: {shown}')
        browser.type(Keys.SPACE)

    def test_a_gamepad_pushes_as_far_as_it_is_held(self, browser, holds, observer):
        holds(0.0, 0.0)
        browser.script(PAD + 'pad.axes = [-1, -1]')  # a device whose axes rest at an end
        observer.spin_for(0.3)
        holds(0.0, 0.0)
        browser.script(PAD)  # lies there: its stick trembles
        browser.script('pad.axes = [0.05, -0.04]')
        holds(0.0, 0.0)
        for axes, held in (('[-1, 0.02]', (0.0, 10.0)), ('[0, -1]', (10.0, 0.0)), ('[0.55, 1]', (-10.0, -5.0))):
            browser.script(f'pad.axes = {axes}')
            holds(*held)
        browser.script('pad.axes = [0, 0]; pad.buttons[14].pressed = true')  # its cross is keys: a notch that stays
        holds(0.0, 5.0)
        browser.script('pad.buttons[14].pressed = false; pad.axes = [0.55, 0]')
        holds(0.0, 0.0)
        browser.script('pad.axes = [0, 0]; pad.buttons[0].pressed = true')
        holds(0.0, 0.0)
        browser.script('pad.axes = [1, 0]; pad.buttons[0].pressed = false')
        holds(0.0, -10.0)
        browser.script('pad.buttons[12].pressed = true')
        holds(5.0, -10.0)
        browser.script('navigator.getGamepads = () => [null, null]')  # pulled out: the notch stays, as with keys
        holds(5.0, 0.0)
        browser.type(Keys.ARROW_UP)
        holds(10.0, 0.0)
        browser.type(Keys.SPACE)
        holds(0.0, 0.0)

    def test_bar_goal_and_both_views_are_there(self, browser):
        parts = browser.script("""
            const box = (selector) => { const b = document.querySelector(selector).getBoundingClientRect();
                return [b.left, b.top, b.right, b.bottom]; };
            return [box("svg .plate"), box("svg .obstacle"), box("svg .goal"), box("[data-part=scene]")];""")
        plate, bar, goal, scene = parts
        for inner in (bar, goal):
            assert plate[0] - 2 <= inner[0] and inner[2] <= plate[2] + 2
            assert plate[1] <= inner[1] and inner[3] <= plate[3]
        assert goal[1] > bar[3], 'the goal lies beyond the bar, nearer to who looks'
        assert bar[2] == pytest.approx(plate[2], abs=6) and bar[0] > plate[0] + 20, 'the gap is on the left'
        assert scene[2] <= plate[0], 'the plate from above stands beside the 3D view'

    @pytest.mark.parametrize(('width', 'height'), [(1920, 1080), (1280, 720), (844, 390)])
    def test_every_size_shows_plate_and_keys_whole(self, browser, width, height):
        outer = browser.script('return [outerWidth - innerWidth, outerHeight - innerHeight]')
        browser.driver.set_window_size(width + outer[0], height + outer[1])
        inner = browser.script('return [innerWidth, innerHeight]')
        for selector in ('svg .plate', '[data-key=up]', '[data-key=down]', '[data-key=left]', '[data-key=right]',
                         '[data-key=space]', '.phase'):
            left, top, right, bottom = browser.script(
                f'const b = document.querySelector("{selector}").getBoundingClientRect();'
                'return [b.left, b.top, b.right, b.bottom]')
            assert right - left > 20 and bottom - top > 14, selector
            assert left >= 0 and top >= 0 and right <= inner[0] + 1 and bottom <= inner[1] + 1, selector
            if selector == 'svg .plate':
                for x, y in itertools.product((left + 4, right - 4), (top + 4, bottom - 4)):
                    assert browser.script(f'return document.elementFromPoint({x}, {y}).closest("svg") !== null'), (
                        'something lies over the plate', x, y)
