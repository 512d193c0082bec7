"""The teaching page in a real browser, with a whole session on the live graph behind it, and with a recorded one."""

import json
import signal

import pytest
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.expected_conditions import alert_is_present
from selenium.webdriver.support.wait import WebDriverWait
from shared_control import contract as table
from shared_control_ros import contract
from shared_control_testing.page import SIZES, Browser, serve, served
from shared_control_testing.sessions import MS, START_NS, lesson, message, record

ROLLED = 60
"""Pixels that no ball at rest moves."""
TRIANGLES = 'return getElement(teachPage.scene).renderer.info.render.triangles'
SMOOTHS = 'return getElement(teachPage.scene).renderer.getContext().getContextAttributes().antialias'


@pytest.fixture(scope='class')
def session(domain_id, tmp_path_factory):
    """``shared-control session --tutor page``, practising; its process and the page's address."""
    folder = tmp_path_factory.mktemp('session') / 'session'
    with served('session', '--tutor', 'page', '--test-episodes', '0', '--output', str(folder)) as session:
        yield session


@pytest.fixture(scope='class')
def browser(session):
    browser = Browser()
    yield browser
    browser.close()


@pytest.fixture(scope='class')
def human(observer):
    """``human(m_y)``: wait until M_yh is that."""
    wrenches = observer.listen(contract.HUMAN_WRENCH)

    def wait_for(m_y):
        observer.spin(lambda: wrenches.clear() or observer.spin_for(0.03) or (
            wrenches and wrenches[-1].wrench.torque.y == m_y), what=f'M_yh = {m_y}')

    return wait_for


@pytest.mark.alone
class TestASessionOnThePage:
    """In this order: practice, teaching, stop."""

    def test_it_opens_in_practice(self, browser, session):
        browser.open(session[1])
        browser.wait(lambda: browser.text('phase') == 'Practice', 'practice')
        assert browser.text('role') == 'you teach'
        assert 'stays' in browser.driver.find_element('css selector', '.help').text
        browser.wait(lambda: browser.script(TRIANGLES) > 5000, 'the meshes')
        assert browser.script(SMOOTHS) is False, 'this browser draws by software'
        assert not browser.part('focus').is_displayed()

    def test_keys_move_tray_and_ball_the_right_way(self, browser, human):
        for key, name, m_y, sign in ((Keys.ARROW_RIGHT, 'right', -5.0, 1), (Keys.ARROW_LEFT, 'left', 5.0, -1)):
            # Looked at before the moment ends: without one the ball rolls to the left end, as soon as it can.
            scene, close = browser.ball_on_screen(), self.ball_in_close_view(browser)
            browser.type(Keys.SPACE)
            human(0.0)
            browser.keys().key_down(key).perform()
            human(m_y)
            assert 'down' in browser.driver.find_element('css selector', f'[data-key={name}]').get_attribute('class')
            browser.keys().key_up(key).perform()
            browser.wait(lambda m_y=m_y: browser.text('human-moment') == f'{m_y:+.1f}'.replace('-', '−'), 'the number')
            lit = f'return document.querySelectorAll("[data-key={name}] .on").length'
            browser.wait(lambda lit=lit: browser.script(lit) == 1, 'a notch')
            browser.wait(lambda m_y=m_y: any(m_y == point[1] for point in browser.chart('moments')[0]), 'the chart')
            browser.wait(lambda scene=scene, sign=sign: sign * (browser.ball_on_screen() - scene) > ROLLED, 'the scene')
            browser.wait(lambda close=close, sign=sign: sign * (self.ball_in_close_view(browser) - close) > ROLLED,
                         'the close view')

    @staticmethod
    def ball_in_close_view(browser):
        return browser.script('return document.querySelector("[data-part=close-ball]").getBoundingClientRect().x')

    def test_keys_can_be_clicked(self, browser, human):
        browser.type(Keys.SPACE)
        human(0.0)
        browser.keys().click(browser.driver.find_element('css selector', '[data-key=left]')).perform()
        human(5.0)
        browser.keys().click(browser.driver.find_element('css selector', '[data-key=space]')).perform()
        human(0.0)

    def test_the_chart_of_moments_moves(self, browser):
        before = browser.chart('moments')
        browser.wait(lambda: browser.chart('moments') != before, 'new data')

    def test_a_window_without_focus_lets_go_and_says_so(self, browser, human):
        browser.type('a')
        human(5.0)
        first = browser.driver.current_window_handle
        browser.driver.switch_to.new_window('tab')
        human(0.0)
        browser.driver.switch_to.window(first)
        browser.script('window.dispatchEvent(new Event("blur"))')
        assert browser.part('focus').is_displayed()
        browser.keys().move_to_element(browser.part('focus')).click().perform()
        browser.script('window.dispatchEvent(new Event("focus"))')
        assert not browser.part('focus').is_displayed()

    def test_a_second_page_can_only_watch(self, browser, session, human):
        first = browser.driver.current_window_handle
        second = browser.open_tab(session[1])
        browser.wait(lambda: 'another page teaches' in browser.text('role'), 'its role')
        assert not browser.part('start').is_displayed()
        browser.wait(lambda: browser.text('doing').startswith('You are watching'), 'that it only watches')
        browser.type(Keys.ARROW_LEFT)
        refused = browser.driver.execute_async_script("""
            const socket = new WebSocket(`ws://${location.host}/live`), done = arguments[0];
            socket.onopen = () => {
              for (const keys of [[1, 0, 0], [0, 0, 0]]) socket.send(JSON.stringify({keys}));
              socket.send(JSON.stringify({do: "stop"}));
              setTimeout(() => { done(true); socket.close(); }, 300);
            }""")
        assert refused
        human(0.0)
        browser.driver.switch_to.window(first)
        browser.type(Keys.ARROW_LEFT)
        human(5.0)
        browser.driver.close()  # the teacher goes, without a word
        human(0.0)
        browser.driver.switch_to.window(second)
        browser.wait(lambda: browser.text('role') == 'nobody teaches', 'the free seat')
        browser.part('take-seat').click()
        browser.wait(lambda: browser.text('role') == 'you teach', 'the seat')

    def test_reload_works(self, browser, human):
        browser.type(Keys.ARROW_RIGHT)
        human(-5.0)
        browser.driver.refresh()
        human(0.0)
        browser.wait(lambda: browser.text('role') == 'you teach', 'the seat')
        browser.type(Keys.ARROW_RIGHT)
        human(-5.0)

    def test_teaching_starts_over_and_pauses(self, browser, observer):
        times = observer.listen(contract.TIME_LEFT)
        start = browser.part('start').rect
        browser.part('start').click()
        browser.wait(lambda: browser.text('phase') == 'Teach · episode 1', 'teaching')
        assert not self.overlap(start, browser.part('finish').rect), 'a second click must not end the teaching'
        observer.spin(lambda: times and 3.0 < times[-1].data < 14.0)
        browser.part('repeat').click()
        observer.spin(lambda: times[-1].data > 14.5, what='the episode to start over')
        browser.part('pause').click()
        browser.wait(lambda: browser.text('doing') == 'Paused: everything waits, and keys do not count.', 'the pause')
        assert not browser.part('repeat').is_enabled()
        browser.part('pause').click()
        browser.wait(lambda: 'Paus' not in browser.text('doing'), 'going on')

    @staticmethod
    def overlap(one, other):
        return all(one[at] < other[at] + other[size] and other[at] < one[at] + one[size]
                   for at, size in (('x', 'width'), ('y', 'height')))

    def test_done_asks_and_can_be_taken_back(self, browser):
        # Clicks of a script come at once: none of them answers the question, which must stand for a moment.
        # Not while the one is hidden, between two episodes: the other would answer a question of the time before.
        click = ('if (document.querySelector("[data-part=finish]").offsetParent)'
                 ' for (const name of ["finish", "yes"]) document.querySelector(`[data-part=${name}]`).click()')
        browser.wait(lambda: browser.script(click) or browser.part('sure').is_displayed(), 'the question')
        assert not browser.script('return teachPage.picture.ends_teaching')
        browser.wait(lambda: browser.part('yes').click() or not browser.part('sure').is_displayed(), 'yes')
        browser.wait(lambda: browser.part('ending').is_displayed(), 'the end to be announced')
        browser.part('keep-teaching').click()
        browser.wait(lambda: browser.part('finish').is_displayed(), 'the teaching to go on')

    def test_an_episode_ends_in_the_charts(self, browser):
        before = len(browser.chart('returns')[0])  # on a slow machine one has ended by itself
        for _ in range(2):
            browser.type(Keys.ARROW_RIGHT)  # the ball falls, soon: nobody has to wait for 15 s
        browser.wait(lambda: browser.text('card-outcome').startswith('The ball '), 'how it ended', timeout=60)
        browser.wait(lambda: browser.text('card-next').startswith('Next in'), 'when the next begins')
        browser.wait(lambda: len(browser.chart('returns')[0]) == before + 1, 'the return', timeout=60)
        assert 0 <= browser.chart('shares')[0][-1] <= 100

    def test_the_person_judges_it(self, browser):
        pressed = 'return [...document.querySelectorAll(".judge [aria-pressed=true]")].map((b) => b.dataset.part)'
        ended = len(browser.chart('returns')[0])
        assert browser.text('judged') == f'Episode {ended}'
        assert 'is to be forgotten' in browser.driver.find_element('css selector', '.help').text
        browser.type('g')
        browser.wait(lambda: browser.script(pressed) == ['judge-success'], 'the verdict')
        browser.part('judge-discard').click()
        browser.wait(lambda: browser.script(pressed) == ['judge-discard'], 'the other verdict')
        browser.wait(lambda: len(browser.chart('returns')[0]) == ended - 1, 'a chart without it')
        for size in SIZES:
            browser.size(*size)
            assert browser.script(TOO_LONG) == [], f'words that do not fit at {size}'
        browser.size(1000, 700)

    def test_nothing_went_wrong_in_the_browser(self, browser):
        assert browser.complaints() == []

    def test_stop_ends_the_session_and_keeps_it(self, browser, session):
        browser.part('stop').click()
        WebDriverWait(browser.driver, 30).until(alert_is_present()).accept()
        said, _ = session[0].communicate(timeout=60)
        assert session[0].returncode == 130
        assert 'Stopped before the end' in said and 'Traceback' not in said


TOO_LONG = ('return [...document.querySelectorAll("button")].filter((b) => b.scrollWidth > b.clientWidth + 1)'
            '.map((b) => b.textContent)')
NEEDED = ('.phase', '[data-part=close-view]', '[data-key=left]', '[data-key=space]', '[data-key=right]',
          '[data-part=start]', '[data-part=pause]', '[data-part=stop]')
BOX = ('const b = document.querySelector("%s").getBoundingClientRect();'
       'return {x: b.left, y: b.top, width: b.width, height: b.height}')


@pytest.mark.alone
class TestASessionByTheKeyboardAlone:
    """In this order, from the practice to the end card and beyond."""

    @pytest.fixture(scope='class')
    @staticmethod
    def session(page_session):
        return page_session

    @staticmethod
    def tab_to(browser, name):
        """Press Tab until the focus is on a button."""
        for _ in range(30):
            browser.type(Keys.TAB)
            if browser.script('return document.activeElement.dataset.part') == name:
                return
        raise AssertionError(f'Tab does not reach {name}')

    def test_every_size_shows_what_teaching_needs(self, browser, session):
        browser.open(session[1])
        browser.wait(lambda: browser.text('phase') == 'Practice', 'practice')
        for width, height in SIZES:
            browser.size(width, height)
            boxes = [browser.script(BOX % selector) for selector in NEEDED]
            for selector, box in zip(NEEDED, boxes, strict=True):
                assert box['x'] >= 0 and box['y'] >= 0, (width, height, selector)
                assert box['x'] + box['width'] <= width + 1 and box['y'] + box['height'] <= height + 1, (
                    width, height, selector, box)
                if selector.startswith(('[data-key', '[data-part=st', '[data-part=pa')):
                    assert min(box['width'], box['height']) >= 44, (width, height, selector, box)
            for i, one in enumerate(boxes):
                for j, other in enumerate(boxes[:i]):
                    overlap = TestASessionOnThePage.overlap(one, other)
                    assert not overlap, (width, height, NEEDED[i], NEEDED[j])
            assert browser.script('return document.documentElement.scrollWidth') <= width + 1, (width, height)

    def test_it_is_taught_and_ended(self, browser):
        browser.size(1000, 700)
        browser.type(Keys.ENTER)
        browser.wait(lambda: browser.text('card-next').startswith('Next in'), 'the countdown')
        browser.wait(lambda: browser.text('phase') == 'Teach · episode 1', 'teaching')
        browser.type('p')
        browser.wait(lambda: browser.text('pause-text') == 'Go on', 'the pause')
        browser.type('p')
        browser.wait(lambda: browser.text('pause-text') == 'Pause', 'going on')
        self.tab_to(browser, 'finish')
        browser.wait(lambda: browser.type(Keys.ENTER) or browser.part('sure').is_displayed(), 'the question')
        browser.wait(lambda: browser.script('return document.activeElement.dataset.part') == 'no', 'the focus')
        browser.type(Keys.TAB)
        browser.wait(lambda: browser.type(Keys.ENTER) or browser.part('ending').is_displayed(), 'the end is announced')
        for key in (Keys.ARROW_RIGHT, 'd'):
            browser.type(key)  # the ball falls, soon

    def test_the_end_card_has_the_result_and_stays(self, browser, session):
        browser.wait(lambda: browser.part('close').is_displayed(), 'the end', timeout=120)
        tested = json.loads((session[2] / 'test.json').read_text())
        said = f'Your robot alone kept the ball in the middle in {tested["successes"]} of 1 tests.'
        assert browser.text('end-words') == said
        browser.wait(lambda: browser.script(
            'return document.querySelector("[data-part=end-picture]").naturalWidth') > 500, 'the picture')
        status = browser.driver.execute_async_script(
            'fetch(document.querySelector("[data-part=end-report]").href).then((r) => arguments[0](r.status))')
        assert status == 200
        browser.driver.refresh()
        browser.wait(lambda: browser.part('close').is_displayed() and browser.text('end-words') == said, 'it again')
        assert session[0].poll() is None

    def test_closing_is_a_choice(self, browser, session):
        self.tab_to(browser, 'close')
        browser.type(Keys.ENTER)
        session[0].communicate(timeout=60)
        assert session[0].returncode == 0
        assert browser.text('end-words') == 'You can close this window.'
        assert not browser.script('const p = document.getElementById("popup"); return p && p.offsetParent')
        assert not (session[2] / 'ending.json').exists()


@pytest.fixture
def replay(tmp_path):
    """The address of a replay of two episodes of 6 s."""
    made = record([lesson(300, seed=1), lesson(300, seed=2)])
    made.add(table.VERDICT, START_NS + 7_000 * MS, message(table.VERDICT.type, key='teach 1', value='success'))
    bag = made.write(tmp_path / 'bag')
    process, address = serve('replay', str(bag))
    yield address
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=60)
    assert process.returncode == 0


def test_a_recorded_session_plays_on_the_page(replay):
    browser = Browser()
    try:
        browser.open(replay)
        browser.wait(lambda: browser.text('phase') == 'Teach · episode 1', 'the first episode')
        assert browser.driver.find_element('css selector', '.marks').text.split() == ['1✓', '2'], 'with the verdict'
        assert browser.text('position') == '0:00 / 0:12', 'it waits for whoever watches'
        browser.script('const s = document.querySelector("[data-part=slider]"); s.value = 8;'
                       's.dispatchEvent(new Event("input"))')
        browser.wait(lambda: browser.text('position') == '0:08 / 0:12', 'the slider')
        browser.wait(lambda: browser.text('phase') == 'Teach · episode 2', 'the second episode')
        browser.wait(lambda: browser.chart('returns') == [[-100.0]], 'the chart')
        before = browser.ball_on_screen()
        browser.part('speed').find_element('css selector', '[value="8"]').click()
        browser.wait(lambda: browser.script('return teachPage.picture.replay.speed') == 8, 'the speed')
        browser.type(Keys.SPACE)
        browser.wait(lambda: browser.text('position') == '0:12 / 0:12', 'the end')
        assert browser.ball_on_screen() != before
        assert browser.complaints() == []
    finally:
        browser.close()
