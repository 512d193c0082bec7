"""A participant's way through a study on the page: everything comes at one address, one thing after the other."""

import json
import re
import signal
import subprocess
import sys
from contextlib import suppress

import pytest
from selenium.common.exceptions import (
    ElementClickInterceptedException,
    ElementNotInteractableException,
    WebDriverException,
)
from selenium.webdriver.common.keys import Keys
from shared_control.processes import leave_with_the_parent
from shared_control_testing.page import SIZES, Browser
from teach_page_node.address import free_port

pytestmark = pytest.mark.alone
PLAN = """
participants:
  real: 2
  consent: "Your consent\\nYou may stop at any time."
  practice_rests: 0
  feedback: none
  session_options: [--page, '127.0.0.1:{port}', --params-file, {parameters}]
  before: {{age: {{ask: 'How old are you?', choices: [under 40, 40 or older]}}}}
conditions: {{coached: , thesis: }}
"""


class Participant:
    """Reads what is on the page, and answers."""

    def __init__(self, browser, address):
        self._browser = browser
        self._address = address

    def begins(self):
        self._browser.wait(self._opens, 'the first page', 60)

    def _opens(self):
        try:
            self._browser.driver.get(self._address)
        except WebDriverException:  # nobody listens yet
            return False
        return self.reads()

    def reads(self):
        """The title of what is shown; while one page gives way to the next there is none."""
        try:
            return self._browser.script('return document.querySelector("h1, [data-part=phase]")?.textContent')
        except WebDriverException:
            return None

    def waits_for(self, title):
        self._browser.wait(lambda: (self.reads() or '').startswith(title), title, 400)

    def ends_the_teaching(self):
        """Whether it ends; click what leads there, if it is there: the rests between these episodes are short."""
        for button in ('yes', 'finish'):
            with suppress(ElementNotInteractableException, ElementClickInterceptedException):  # it is gone
                self._browser.part(button).click()
        return self._browser.script('return teachPage.picture.ends_teaching || teachPage.picture.phase === "test"') or (
            self._browser.part('close').is_displayed())

    def chooses(self, text):
        self._browser.driver.find_element('xpath', f'//*[normalize-space(text())="{text}"]').click()


@pytest.fixture
def browser():
    browser = Browser()
    yield browser
    browser.close()


@pytest.fixture
def study(domain_id, tmp_path, unpaced):
    """``shared-control study --participant 1``, and its address."""
    port = free_port('127.0.0.1')
    (tmp_path / 'plan.yaml').write_text(PLAN.format(port=port, parameters=unpaced))
    process = subprocess.Popen(
        [sys.executable, '-m', 'shared_control', 'study', str(tmp_path / 'plan.yaml'), '--participant', '1',
         '--output', str(tmp_path / 'study')], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT, text=True, preexec_fn=leave_with_the_parent)
    yield process, f'http://127.0.0.1:{port}/'
    if process.poll() is None:
        process.send_signal(signal.SIGTERM)
    process.communicate(timeout=60)


def test_a_participant_teaches_is_asked_and_leaves(study, browser, tmp_path):
    process, address = study
    person = tmp_path / 'study' / 'people' / 'p01'
    participant = Participant(browser, address)
    participant.begins()
    participant.waits_for('Your consent')
    participant.chooses('I agree')
    participant.waits_for('Before you begin')
    participant.chooses('under 40')
    participant.chooses('Go on')
    participant.waits_for('Part 1 of 2')
    participant.chooses('Go on')
    participant.waits_for('Practice')
    browser.wait(lambda: browser.text('role') == 'you teach', 'the seat')
    for size in SIZES:
        browser.size(*size)
        assert not browser.part('human-moment').is_displayed(), f'feedback: none, at {size}'
    assert not browser.driver.find_elements('css selector', '[data-part=judge]'), 'verdicts: false'
    browser.type('g')
    browser.type(Keys.ENTER)
    participant.waits_for('Teach')
    browser.wait(participant.ends_the_teaching, 'the end of the teaching', 180)
    browser.wait(lambda: browser.part('close').is_displayed(), 'the end', 240)
    assert browser.text('end-words') == 'This part is over.' and browser.text('close-text') == 'Go on'
    assert not browser.part('end-report').is_displayed()
    browser.part('close').click()
    participant.waits_for('How was part 1 of 2?')
    for slider in browser.driver.find_elements('css selector', 'input[type=range]'):
        slider.send_keys(Keys.ARROW_RIGHT)
    participant.chooses('Go on')
    participant.waits_for('Part 2 of 2')
    progress = json.loads((person / 'progress.json').read_text())
    assert progress['tlx']['coached'] == dict.fromkeys(progress['tlx']['coached'], 55.0)
    assert progress['before'] == {'age': 'under 40'} and progress['practice']['met'] is True
    settings = json.loads((person / 'coached' / 'settings.json').read_text())
    assert (settings['feedback'], settings['verdicts']) == ('none', False)

    participant.chooses('Go on')
    participant.waits_for('Practice')
    browser.wait(lambda: browser.text('role') == 'you teach', 'the seat')
    browser.part('stop').click()
    browser.driver.switch_to.alert.accept()
    participant.waits_for('You have stopped.')
    participant.chooses('I leave; delete what was recorded')
    participant.waits_for('Thank you for taking part. What was recorded is deleted.')
    said, _ = process.communicate(timeout=60)
    assert process.returncode == 130
    assert 'coached' not in said and str(person) not in said, 'the experimenter may turn the screen'
    assert json.loads((person / 'progress.json').read_text())['withdrawn'] == 'delete'
    assert sorted(path.name for path in person.iterdir()) == ['.lock', 'progress.json']
    # The page of a part that is over asks for its server, which is gone, or finds that of the forms in its place.
    assert [said for said in browser.complaints() if not re.search('ERR_CONNECTION|WebSocket handshake', said)] == []
