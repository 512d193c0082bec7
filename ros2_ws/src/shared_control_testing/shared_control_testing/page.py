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

"""The page in a real browser, for tests and measurements: headless Chromium, drawing by software."""

import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.resources import files
from typing import Any

from selenium.webdriver import ActionChains, Chrome, ChromeOptions
from selenium.webdriver.chrome.service import Service
from shared_control.processes import leave_with_the_parent

SIZES = ((1920, 1080), (1366, 768), (844, 390), (683, 384), (390, 844))
"""Windows, CSS pixels: two screens, a phone held sideways, 1366 x 768 at 200 %, a phone."""
_BROWSERS = ('chromium', 'chromium-browser', 'google-chrome')
_OPTIONS = (
    '--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run',
    '--disable-background-networking', '--disable-component-update', '--disable-sync', '--use-gl=angle',
    '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--hide-scrollbars')
_BALL_ON_SCREEN = """
    const view = getElement(teachPage.scene);
    const ball = [...view.objects.values()].find(({mesh}) => mesh?.name === 'ball').mesh;
    return (ball.getWorldPosition(ball.position.clone()).project(view.camera).x + 1) / 2 * view.$el.clientWidth"""

_NAMED = ('button', 'link', 'slider', 'combobox', 'textbox', 'radio', 'image', 'img', 'group', 'dialog')
_MIDDLE = """
    const element = document.querySelector('{selector}');
    const box = element.getBoundingClientRect(), x = box.left + box.width / 2, y = box.top + box.height / 2;
    const front = document.elementFromPoint(x, y);
    if (!element.contains(front)) throw new Error(`{selector} is behind ${{front?.outerHTML.slice(0, 200)}}`);
    return [x, y]"""


def serve(*arguments: str) -> tuple[subprocess.Popen[str], str]:
    """Start ``shared-control`` with ``arguments`` that serve a page; the process, and the address that it prints."""
    process = subprocess.Popen(
        [sys.executable, '-m', 'shared_control', *arguments, '--page', '127.0.0.1:0'], stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, preexec_fn=leave_with_the_parent)
    assert process.stdout is not None
    said = ''
    while not (found := re.search(r'(?:Teach|Watch) here: (http://127\S+)', said)):
        line = process.stdout.readline()
        assert line, f'{arguments[0]} ended: {said}'
        said += line
    return process, found[1]


@contextmanager
def served(*arguments: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """The same for as long as it is needed; the process is ended then, if it has not ended by itself."""
    process, address = serve(*arguments)
    try:
        yield process, address
    finally:
        if process.poll() is None:
            process.send_signal(signal.SIGTERM)
        process.communicate(timeout=120)


class Browser:
    """Chromium with a profile of its own.

    Args:
        width, height: of its window, pixels.
        webgl: whether it can draw in 3D.

    Raises:
        FileNotFoundError: there is no Chromium, or no chromedriver.
    """

    def __init__(self, width: int = 1000, height: int = 700, webgl: bool = True):
        browser = next(filter(None, map(shutil.which, _BROWSERS)), None)
        driver = shutil.which('chromedriver')
        if browser is None or driver is None:
            raise FileNotFoundError('no Chromium or no chromedriver: run tools/install_browser.sh as root')
        self._profile = tempfile.TemporaryDirectory()
        options = ChromeOptions()
        options.binary_location = browser
        for option in (*_OPTIONS, f'--user-data-dir={self._profile.name}', f'--window-size={width},{height}',
                       *(() if webgl else ('--disable-3d-apis',))):
            options.add_argument(option)
        options.set_capability('goog:loggingPrefs', {'browser': 'ALL'})
        self.driver = Chrome(options=options, service=Service(driver))

    def open(self, address: str) -> None:
        """Open the page and wait until it shows something."""
        self.driver.get(address)
        self.wait(lambda: self.script('return window.teachPage?.picture?.q'), 'a picture')

    def size(self, width: int, height: int) -> None:
        """Make the window show a page of so many CSS pixels: less than that of a screen that is enlarged."""
        self.driver.execute_cdp_cmd('Emulation.setDeviceMetricsOverride', {
            'width': width, 'height': height, 'deviceScaleFactor': 1, 'mobile': False})

    def open_tab(self, address: str) -> str:
        """Open the page in a second tab, which is then in front; its handle."""
        self.driver.switch_to.new_window('tab')
        self.open(address)
        return self.driver.current_window_handle

    def script(self, code: str) -> Any:
        """What a piece of JavaScript returns."""
        return self.driver.execute_script(code)

    def wait(self, condition: Callable[[], Any], what: str, timeout: float = 60.0) -> Any:
        """Wait until ``condition()`` is true, and give its value."""
        deadline = time.monotonic() + timeout
        while not (value := condition()):
            if time.monotonic() > deadline:
                raise AssertionError(f'waited {timeout} s in vain for {what}; the page says {self.shown()!r}')
            time.sleep(0.03)
        return value

    def part(self, name: str) -> Any:
        """An element of the page."""
        return self.driver.find_element('css selector', f'[data-part="{name}"]')

    def text(self, name: str) -> str:
        """What an element of the page says."""
        return self.part(name).text

    def shown(self) -> str:
        """What the page says in words."""
        return self.driver.find_element('css selector', 'main').text

    def keys(self) -> ActionChains:
        """Keys and mouse."""
        return ActionChains(self.driver)

    def type(self, key: str) -> None:
        """Press a key and let it go."""
        self.keys().send_keys(key).perform()

    def ball_on_screen(self) -> float:
        """Where the ball of the scene is, pixels from the scene's left side."""
        return self.script(_BALL_ON_SCREEN)

    def chart(self, name: str) -> list[list[Any]]:
        """The data of a chart's series."""
        return self.script(f'return getElement(teachPage.{name}).chart.getOption().series.map((s) => s.data)')

    def hold_as_a_phone(self, width: int, height: int) -> None:
        """Be a phone of so many CSS pixels, with a screen that is touched."""
        self.driver.execute_cdp_cmd('Emulation.setDeviceMetricsOverride', {
            'width': width, 'height': height, 'deviceScaleFactor': 2, 'mobile': True})
        self.driver.execute_cdp_cmd('Emulation.setTouchEmulationEnabled', {'enabled': True, 'maxTouchPoints': 2})

    def touch(self, selector: str) -> None:
        """Put a finger on the middle of an element, which must be in sight and in front there, and lift it."""
        x, y = self.script(_MIDDLE.format(selector=selector))
        for kind, points in (('touchStart', [{'x': x, 'y': y}]), ('touchEnd', [])):
            self.driver.execute_cdp_cmd('Input.dispatchTouchEvent', {'type': kind, 'touchPoints': points})

    def barriers(self) -> list[str]:
        """What axe-core finds on the page as it is now that is serious or critical: rule, and where."""
        if not self.script('return Boolean(window.axe)'):
            self.script((files('axe_core_python') / 'axe.min.js').read_text(encoding='utf-8'))
        found = self.driver.execute_async_script("""
            const done = arguments[0];
            axe.run(document, {resultTypes: ["violations"]}).then((r) => done(r.violations), (e) => done(String(e)))""")
        assert isinstance(found, list), found
        return [f'{rule["id"]} ({rule["impact"]}): {node["target"]} {node["failureSummary"]}' for rule in found
                if rule['impact'] in ('serious', 'critical') for node in rule['nodes']]

    def nameless(self) -> list[dict[str, Any]]:
        """What a screen reader would stop at without being able to say what it is."""
        nodes = self.driver.execute_cdp_cmd('Accessibility.getFullAXTree', {})['nodes']
        return [node for node in nodes if not node['ignored'] and node['role']['value'] in _NAMED
                and not node.get('name', {}).get('value', '').strip()]

    def complaints(self) -> list[str]:
        """Errors that the page has logged."""
        return [entry['message'] for entry in self.driver.get_log('browser') if entry['level'] == 'SEVERE']

    def close(self) -> None:
        """End the browser."""
        self.driver.quit()
        self._profile.cleanup()
