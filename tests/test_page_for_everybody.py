"""Who cannot see, has a phone, or enlarges: axe-core, names and roles in every state, a whole session by touch."""

import json
import re
import signal
import threading

import pytest
from shared_control_records.study.form_page import FormPage
from shared_control_records.study.plan_file import Question
from shared_control_records.study.progress import SCALES
from shared_control_testing.page import Browser, serve
from shared_control_testing.sessions import lesson, record
from teach_page_node import layout
from teach_page_node.address import free_port
from teach_page_node.server import STATIC

SIDEWAYS = (844, 390)
ENLARGED = (683, 384)
"""A window of 1366 x 768 at 200 %."""


@pytest.fixture(scope='module')
def browser():
    browser = Browser()
    yield browser
    browser.close()


def part(name):
    return f'[data-part="{name}"]'


def key(name):
    return f'[data-key="{name}"]'


@pytest.mark.alone
class TestASessionByTouch:
    """On a phone held sideways, in this order; what axe-core says of every state."""

    def test_practice(self, browser, page_session):
        browser.hold_as_a_phone(*SIDEWAYS)
        browser.open(page_session[1])
        browser.wait(lambda: browser.text('phase') == 'Practice', 'practice')
        browser.touch(key('left'))
        browser.wait(lambda: browser.text('human-moment') == '+5.0', 'the push')
        browser.wait(lambda: browser.text('push') == 'Your push stays. Space takes it away.', 'what becomes of it')
        assert browser.barriers() == [] == browser.nameless()
        browser.touch(key('space'))
        browser.wait(lambda: browser.text('push') == 'No push.', 'the push to be gone')

    def test_what_changes_is_said(self, browser):
        live = browser.script("""return [...document.querySelectorAll('[aria-live], [role="status"]')]
            .map((element) => element.dataset.part)""")
        assert {'doing', 'push', 'card-outcome', 'role', 'end-words'} <= set(live)
        assert browser.script('return document.querySelectorAll("h1").length') == 1

    def test_countdown_and_teaching(self, browser):
        browser.touch(part('start'))
        browser.wait(lambda: browser.text('card-next').startswith('Next in'), 'the countdown')
        assert browser.barriers() == []
        browser.wait(lambda: browser.text('phase') == 'Teach · episode 1', 'teaching', 60)
        assert browser.barriers() == [] == browser.nameless()

    def test_pause(self, browser):
        browser.touch(part('pause'))
        browser.wait(lambda: browser.text('pause-text') == 'Go on', 'the pause')
        assert browser.text('push') == 'Your keys do not count now.'
        assert browser.barriers() == []
        browser.touch(part('pause'))
        browser.wait(lambda: browser.text('pause-text') == 'Pause', 'going on')

    def test_the_question_and_its_answers(self, browser):
        self.touch_until(browser, 'finish', 'sure')
        assert browser.barriers() == [] == browser.nameless()
        browser.wait(lambda: browser.touch(part('no')) or browser.part('finish').is_displayed(), 'no')
        self.touch_until(browser, 'finish', 'sure')
        browser.wait(lambda: not browser.part('sure').is_displayed() or browser.touch(part('yes')), 'yes')
        browser.wait(lambda: browser.part('ending').is_displayed(), 'the end to be announced')
        assert browser.barriers() == []

    @staticmethod
    def touch_until(browser, name, shown):
        """Buttons that have just come are no target yet."""
        browser.wait(lambda: browser.part(shown).is_displayed() or not browser.part(name).is_displayed()
                     or browser.touch(part(name)), shown)
        browser.wait(lambda: browser.part(shown).is_displayed(), shown)

    def test_a_fallen_ball_and_learning(self, browser):
        for _ in range(2):
            browser.touch(key('right'))
        browser.wait(lambda: browser.text('card-outcome').startswith('The ball '), 'how it ended', 60)
        assert browser.text('push') == 'Your keys do not count now.'
        assert browser.barriers() == []

    def test_the_robot_alone(self, browser):
        browser.wait(lambda: browser.text('phase').startswith('The robot alone'), 'the test', 60)
        assert browser.barriers() == []

    def test_enlarged_the_end_card_is_whole_and_within_reach(self, browser, page_session):
        browser.wait(lambda: browser.part('close').is_displayed(), 'the end', 180)
        assert browser.barriers() == [] == browser.nameless()
        browser.size(*ENLARGED)
        browser.script('document.querySelector(\'[data-part="close"]\').scrollIntoView()')
        tested = json.loads((page_session[2] / 'test.json').read_text())
        assert browser.text('end-words').endswith(f'in {tested["successes"]} of 1 tests.')
        browser.wait(lambda: browser.script('return document.documentElement.scrollWidth <= innerWidth'), 'the layout')
        assert browser.complaints() == []
        browser.touch(part('close'))
        page_session[0].communicate(timeout=60)
        assert page_session[0].returncode == 0


def test_a_replay_has_no_barriers(browser, tmp_path):
    bag = record([lesson(300, seed=1), lesson(300, seed=2)]).write(tmp_path / 'bag')
    process, address = serve('replay', str(bag))
    try:
        browser.size(1366, 768)
        browser.open(address)
        browser.wait(lambda: browser.text('phase') == 'Teach · episode 1', 'the first episode')
        assert browser.barriers() == [] == browser.nameless()
    finally:
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)


@pytest.mark.parametrize(('ask', 'arguments'), [
    ('consent', ['Consent\nYou may stop.']), ('rate', ['How was it?', SCALES, lambda name, value: None]),
    ('answer', ['Before', {'age': Question(ask='Your age?', choices=['18', 'more']), 'say': Question(ask='And?')}])])
def test_the_forms_of_a_study_have_no_barriers_and_are_filled_in_by_keys_alone(browser, ask, arguments):
    page = FormPage(port=free_port('127.0.0.1'))
    thread = threading.Thread(target=getattr(page, ask), args=arguments, daemon=True)
    thread.start()
    browser.size(390, 844)
    browser.wait(lambda: reaches(browser, page.address), 'the form')
    assert browser.barriers() == [] == browser.nameless()
    assert browser.script('return document.documentElement.scrollWidth <= innerWidth')
    small = browser.script("""return [...document.querySelectorAll("button, input:not([type=hidden]), label, textarea")]
        .filter((e) => e.type !== "radio" && e.getBoundingClientRect().height < 44).map((e) => e.outerHTML)""")
    assert small == []
    for _ in range(20):
        browser.type('\ue004')  # Tab
        tag, kind = browser.script('const e = document.activeElement; return [e.tagName, e.type]')
        if kind in ('range', 'radio'):
            browser.type('\ue014' if kind == 'range' else ' ')  # to the right; chosen
        elif tag == 'BUTTON':
            browser.type('\ue007')
            break
    browser.wait(lambda: browser.script('return document.querySelector("h1")?.textContent') == 'Thank you.', 'thanks')
    thread.join(60)
    assert not thread.is_alive()


def reaches(browser, address):
    try:
        browser.driver.get(address)
    except Exception:  # nobody listens yet
        return False
    return browser.script('return document.forms.length > 0')


def luminance(colour):
    """Relative luminance of #rgb or #rrggbb (WCAG 2.2)."""
    digits = colour.lstrip('#')
    digits = ''.join(2 * digit for digit in digits) if len(digits) == 3 else digits
    channels = [int(digits[i:i + 2], 16) / 255 for i in (0, 2, 4)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one, other):
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


CSS = (STATIC / 'page.css').read_text(encoding='utf-8')
VARIABLES = dict(re.findall(r'--([a-z]+): (#[0-9a-f]+);', CSS))


@pytest.mark.parametrize('name', ['human', 'agent', 'sum', 'goal', 'quiet'])
def test_text_in_every_colour_can_be_read_and_charts_have_the_same(name):
    for ground in ('#fff', '#f4f6f8'):
        assert contrast(VARIABLES[name], ground) >= 4.5, (name, ground)
    drawn = {'human': layout._HUMAN, 'agent': layout._AGENT, 'sum': layout._SUM}
    assert drawn.get(name, VARIABLES[name]) == VARIABLES[name]


def test_white_can_be_read_on_every_phase_and_edges_are_seen():
    grounds = re.findall(r'\.phase\.\w+ \{ background: (#[0-9a-f]+|var\(--\w+\))', CSS)
    assert len(grounds) == 5
    for ground in grounds:
        assert contrast('#fff', VARIABLES.get(ground[6:-1], ground)) >= 4.5, ground
    assert contrast(VARIABLES['edge'], '#fff') >= 3.0  # of what is no text
