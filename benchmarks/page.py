"""The page beside the control loop: from a key in the browser to M_yh, pictures a second, and what it costs the loop.

The nodes run as in a session (the control loop on the last core, the others on the rest), the agent in practice: first
without a browser, then with Chromium showing the page. The browser draws by software, in a small window; a computer
with a graphics card draws for nothing.
"""

import json
import os
import tempfile
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import rclpy
from rclpy.context import Context
from rclpy.node import Node
from selenium.webdriver.common.keys import Keys
from shared_control_bringup import parameters
from shared_control_bringup.graph import Role, nodes_of, overrides
from shared_control_bringup.node_process import NodeProcess
from shared_control_bringup.settings import Settings
from shared_control_ros import contract
from shared_control_ros.fast_loop import Polled
from shared_control_testing.nodes import free_domain
from shared_control_testing.page import Browser
from teach_page_node.address import free_port, page_address

WINDOW = (800, 600)
PRESSES = 60
SECONDS = 20.0
_NOTE_KEYS = """
    window.pressedAt = []
    addEventListener('keydown', () => pressedAt.push(performance.timeOrigin + performance.now()), true)"""
_COUNTS = 'return [teachPage.pictures, getElement(teachPage.scene).renderer.info.render.frame]'


@contextmanager
def session() -> Iterator[tuple[int, str]]:
    """The nodes of a session that practises; their domain, and the page's address."""
    with free_domain() as domain, tempfile.TemporaryDirectory() as folder:
        settings = Settings(tutor='page', page=('127.0.0.1', free_port('127.0.0.1')))
        file = Path(folder) / 'parameters.yaml'
        given = overrides(settings, Path(folder), shows_screen=False)
        parameters.save(parameters.lay_over(parameters.load(), given), file)
        nodes = [NodeProcess(node.name, file, Path(folder) / f'{node.name}.log', in_real_time=True,
                             in_control_loop=node.role is Role.CONTROL_LOOP)
                 for node in nodes_of(settings.tutor) if node.name != 'session_recorder_node']
        try:
            for node in nodes:
                node.start()
                node.wait_ready(60.0)
            yield domain, page_address(*settings.page, token=None)
        finally:
            for node in reversed(nodes):
                node.interrupt()
                node.wait(10.0)


class Ear:
    """Hears M_yh, and how far simulated time comes."""

    def __init__(self, domain: int):
        self._context = Context()
        rclpy.init(context=self._context, domain_id=domain)
        self._node = Node('bench', context=self._context)
        self._human = Polled(self._node, contract.HUMAN_WRENCH)
        self._clock = Polled(self._node, contract.CLOCK)

    def wait_for(self, m_y: float) -> float:
        """Wait until M_yh is ``m_y``; the time of the day then, ms."""
        deadline = time.monotonic() + 10.0
        while time.monotonic() < deadline:
            message = self._human.wait(0.1)
            if message is not None and message.wrench.torque.y == m_y:
                return time.time() * 1e3
        raise TimeoutError(f'M_yh did not become {m_y} N m within 10 s')

    def real_time_factor(self, seconds: float) -> float:
        """Simulated over real time."""
        started, first = time.monotonic(), self._now()
        time.sleep(seconds)
        last = self._now()
        return (last - first) / (time.monotonic() - started)

    def _now(self) -> float:
        self._clock.clear()
        while (message := self._clock.wait(1.0)) is None:
            pass
        return message.clock.sec + message.clock.nanosec * 1e-9

    def close(self) -> None:
        """Leave the graph."""
        self._node.destroy_node()
        self._context.try_shutdown()


def key_latencies(browser: Browser, ear: Ear) -> list[float]:
    """From the browser's keydown event to M_yh on the topic, ms. Both clocks are this machine's."""
    browser.script(_NOTE_KEYS)
    latencies = []
    for _ in range(PRESSES // 2):
        for key, m_y in ((Keys.ARROW_LEFT, 5.0), (Keys.SPACE, 0.0)):
            browser.keys().key_down(key).perform()
            heard = ear.wait_for(m_y)
            latencies.append(heard - browser.script('return pressedAt.pop()'))
            browser.keys().key_up(key).perform()
    return latencies


def pictures_a_second(browser: Browser, seconds: float) -> tuple[float, float]:
    """Pictures that came, and pictures of the scene that were drawn."""
    before, started = browser.script(_COUNTS), time.monotonic()
    time.sleep(seconds)
    after, elapsed = browser.script(_COUNTS), time.monotonic() - started
    came, drawn = ((b - a) / elapsed for a, b in zip(before, after, strict=True))
    return came, drawn


def measure() -> dict[str, Any]:
    """Latency of a key (ms), pictures a second, and the real-time factor without and with the page open.

    Without a browser, the real-time factor without it, and under ``missing`` what is needed for the rest.
    """
    with session() as (domain, address), closing(Ear(domain)) as ear:
        time.sleep(3.0)
        without = ear.real_time_factor(SECONDS)
        figures = {'real_time_factor': {'without_page': round(without, 4)},
                   'load_average': round(os.getloadavg()[0], 1)}
        try:
            browser = Browser(*WINDOW)
        except FileNotFoundError as error:
            return {**figures, 'missing': str(error)}
        with closing(browser):
            browser.open(address)
            time.sleep(8.0)  # the scene has found its resolution
            with_page = ear.real_time_factor(SECONDS)
            came, drawn = pictures_a_second(browser, 10.0)
            latencies = key_latencies(browser, ear)
    p50, p95 = np.percentile(latencies, [50, 95])
    return {**figures, 'key_to_moment_ms': {'p50': round(p50, 1), 'p95': round(p95, 1), 'presses': len(latencies)},
            'pictures_a_second': {'sent': round(came, 1), 'drawn': round(drawn, 1), 'window': list(WINDOW)},
            'real_time_factor': {'without_page': round(without, 4), 'with_page': round(with_page, 4)}}


if __name__ == '__main__':
    print(json.dumps(measure(), indent=2))
