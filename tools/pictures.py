"""Pictures of the page in all its states, at five sizes of window: what teacher and viewer see.

    python tools/pictures.py out/pictures

Starts a session on the page and teaches two episodes badly, plays the session back, opens the detour's practice, goes
through a participant's forms and teaches as one, who is told little. Each state is one picture a size,
STATE-WIDTHxHEIGHT.png; states that last for seconds only have fewer sizes. Needs Chromium (tools/install_browser.sh).
``--docs`` puts those that the documentation shows into docs/images.
"""

import signal
import subprocess
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from PIL import Image
from selenium.common.exceptions import WebDriverException
from selenium.webdriver.common.keys import Keys
from shared_control.command_line import script_parser
from shared_control_records.study.form_page import FormPage
from shared_control_records.study.plan_file import Question
from shared_control_records.study.progress import SCALES
from shared_control_testing.page import SIZES, Browser, serve
from teach_page_node.address import free_port
from tqdm import tqdm

SETTLED = 0.6
"""What a window needs to draw itself at a new size, s."""
IN_DOCS = {
    'practice': 'page-practice', 'teach': 'page-teach', 'replay': 'page-replay', 'detour-practice': 'page-detour'}
COLOURS = 128
"""Of a picture in the documentation: a third of the bytes, and no difference to be seen."""
BRIEF = ((1366, 768), (390, 844))
"""Sizes for what is there for a moment only."""
DOCS_SIZE = (1366, 768)
DOCS = Path(__file__).parents[1] / 'docs' / 'images'


class Camera:
    """Takes pictures of a browser's page."""

    def __init__(self, browser: Browser, folder: Path, progress: tqdm):
        self._browser = browser
        self._folder = folder
        self._progress = progress

    def take(self, state: str, sizes: tuple[tuple[int, int], ...] = SIZES) -> None:
        """A picture of what is shown now at each size; the last size is the largest again."""
        for width, height in sizes:
            self._browser.size(width, height)
            time.sleep(SETTLED)
            self._browser.driver.save_screenshot(str(self._folder / f'{state}-{width}x{height}.png'))
        self._browser.size(*sizes[0])
        self._progress.update()


@contextmanager
def served(*arguments: str, ends_by: int = signal.SIGTERM) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """A command that serves a page, and its address; ended at last."""
    process, address = serve(*arguments)
    try:
        yield process, address
    finally:
        if process.poll() is None:
            process.send_signal(ends_by)
        process.communicate(timeout=90)


def teach(browser: Browser, camera: Camera, folder: Path) -> None:
    """From the practice to the end card."""
    with served('session', '--tutor', 'page', '--test-episodes', '3', '--output', str(folder)) as (_, address):
        browser.driver.get(address)
        browser.wait(lambda: browser.script('return document.querySelector("[data-part=phase]")?.textContent'), 'words')
        camera.take('starting', BRIEF)
        browser.wait(lambda: browser.text('phase') == 'Practice', 'practice', 60.0)
        browser.type(Keys.ARROW_LEFT)
        camera.take('practice')
        window = browser.open_tab(address)
        browser.wait(lambda: browser.text('role') != 'you teach', 'the second window')
        camera.take('watching')
        browser.driver.close()
        browser.driver.switch_to.window(next(name for name in browser.driver.window_handles if name != window))
        browser.script('window.dispatchEvent(new Event("blur"))')
        camera.take('without-focus')
        browser.type(Keys.SPACE)  # a key that arrives proves that it has the focus
        browser.wait(lambda: not browser.part('focus').is_displayed(), 'the focus')
        browser.part('start').click()
        browser.wait(lambda: browser.text('card-next'), 'the countdown')
        camera.take('countdown', BRIEF)
        browser.wait(lambda: browser.text('phase').startswith('Teach'), 'teaching')
        browser.type('p')
        browser.wait(lambda: browser.text('pause-text') == 'Go on', 'the pause')
        camera.take('paused')
        browser.type('p')
        browser.wait(lambda: browser.text('pause-text') == 'Pause', 'going on')
        browser.type(Keys.ARROW_LEFT)
        camera.take('teach')
        let_it_fall(browser)
        camera.take('outcome', BRIEF)
        browser.wait(lambda: browser.text('phase') == 'Teach · episode 2', 'the second episode', 60.0)
        browser.type('g')
        browser.wait(lambda: browser.part('judge-success').get_attribute('aria-pressed') == 'true', 'the verdict')
        browser.wait(lambda: browser.part('finish').click() or browser.part('sure').is_displayed(), 'the question')
        camera.take('question')
        browser.part('yes').click()
        let_it_fall(browser)
        camera.take('last-outcome', BRIEF)
        browser.wait(lambda: browser.part('end').is_displayed(), 'the end', 600.0)
        camera.take('testing', BRIEF)
        browser.wait(lambda: browser.part('close').is_displayed(), 'the result', 180.0)
        time.sleep(1.0)
        camera.take('end')
        browser.part('close').click()


def let_it_fall(browser: Browser) -> None:
    """Push to the left until the episode is over; waits for the words on how it ended."""
    browser.wait(lambda: browser.text('card-outcome') or browser.type(Keys.ARROW_LEFT), 'how the episode ended', 90.0)


def replay(browser: Browser, camera: Camera, folder: Path) -> None:
    """The session played back, from its middle."""
    with served('replay', str(folder), ends_by=signal.SIGINT) as (_, address):
        browser.open(address)
        browser.script('const s = document.querySelector("[data-part=slider]"); s.value = s.max / 2;'
                       's.dispatchEvent(new Event("input"))')
        time.sleep(2.0)
        camera.take('replay')


def two_axes(browser: Browser, camera: Camera, folder: Path) -> None:
    """The practice of the task with two axes."""
    with served('session', '--task', 'detour', '--tutor', 'page', '--test-episodes', '0', '--output',
                str(folder)) as (_, address):
        browser.open(address)
        browser.wait(lambda: browser.text('phase') == 'Practice', 'practice')
        browser.type(Keys.ARROW_LEFT)
        browser.type(Keys.ARROW_UP)
        camera.take('detour-practice')


def participant(browser: Browser, camera: Camera, folder: Path) -> None:
    """The forms of a study, and the teaching of one who is told little."""
    for state, ask, arguments in (
            ('consent', 'consent', ('Your consent\nYou may stop at any time, without a reason.',)),
            ('questions', 'answer', ('Before you begin', {
                'age': Question(ask='How old are you?', choices=['18 to 24', '25 to 34', '35 or older']),
                'comments': Question(ask='What do you want to say?')})),
            ('workload', 'rate', ('How was part 1 of 2?', SCALES, lambda name, value: None))):
        page = FormPage(port=free_port('127.0.0.1'))
        threading.Thread(target=getattr(page, ask), args=arguments, daemon=True).start()
        browser.wait(lambda page=page: _opens(browser, page.address), state)
        camera.take(f'form-{state}')
    with served('session', '--blind', '--tutor', 'page', '--practice-rests', '2', '--test-episodes', '0', '--output',
                str(folder)) as (_, address):
        browser.open(address)
        browser.wait(lambda: browser.text('phase') == 'Practice', 'practice', 60.0)
        browser.type(Keys.ARROW_LEFT)
        camera.take('participant')


def _opens(browser: Browser, address: str) -> bool:
    try:
        browser.driver.get(address)
    except WebDriverException:  # nobody listens yet
        return False
    return browser.script('return document.forms.length > 0')


def main() -> None:
    """Entry point."""
    parser = script_parser(__doc__)
    parser.add_argument('output', type=Path, metavar='FOLDER', help='folder for the pictures')
    parser.add_argument('--docs', action='store_true', help='put those that the documentation shows into docs/images')
    args = parser.parse_args()
    args.output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as sessions, tqdm(unit='state') as progress:
        for show in (teach, replay, two_axes, participant):
            # A session is played back from where it was recorded.
            folder = Path(sessions, 'session' if show in (teach, replay) else show.__name__)
            browser = Browser(*SIZES[0])
            try:
                show(browser, Camera(browser, args.output, progress), folder)
            finally:
                browser.close()
    if args.docs:
        for state, name in IN_DOCS.items():
            taken = Image.open(args.output / f'{state}-{DOCS_SIZE[0]}x{DOCS_SIZE[1]}.png')
            taken.convert('RGB').quantize(COLOURS).save(DOCS / f'{name}.png', optimize=True)
    print(args.output)


if __name__ == '__main__':
    main()
