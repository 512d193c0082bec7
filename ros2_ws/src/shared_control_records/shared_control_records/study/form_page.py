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

"""The page on which a participant is asked: forms, one after the other, at the address at which they also teach.

The pages of a study take turns at one address: a form is served until it is answered, then the page of the session,
then the next form. A page that is done with asks for the next until it is there. Served to this machine only.
"""

import html
import secrets
import time
from collections.abc import Callable, Mapping
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from string import Template
from typing import Any
from urllib.parse import parse_qs

from shared_control.hosts import LOOPBACK, OWN_FRAMES_ONLY, family_of, is_loopback, url_of

from .plan_file import Question
from .progress import Scale

LAST_WORDS = 60.0
"""How long the last page waits for somebody to read it, s."""
SIZE_MAX = 100_000
"""Bytes of an answer."""
_PAGE = Template((Path(__file__).parent / 'form.html').read_text(encoding='utf-8'))


class FormPage:
    """See :class:`.asking.Asker`; asks in the browser.

    Args:
        host, port: where; a host of this machine's own.

    Raises:
        ValueError: the host is open to the network.
    """

    def __init__(self, host: str = '127.0.0.1', port: int = 8088):
        if host not in LOOPBACK:
            raise ValueError(f'the questions of a study are served to this machine only, not at {host}: leave --page '
                             'out of session_options, or say teach_on: terminal')
        self._host, self._port = host, port

    @property
    def address(self) -> str:
        """What the participant opens."""
        return url_of(self._host, self._port)

    def consent(self, text: str) -> bool:
        """See :class:`.asking.Asker`."""
        return self.choose(text, {'yes': 'I agree', 'no': 'I do not agree'}) == 'yes'

    def ready(self, text: str) -> None:
        """See :class:`.asking.Asker`."""
        self.choose(text, {'go_on': 'Go on'})

    def choose(self, text: str, choices: Mapping[str, str]) -> str:
        """See :class:`.asking.Asker`."""
        buttons = ''.join(f'<button name="choice" value="{html.escape(key)}">{html.escape(what)}</button>'
                          for key, what in choices.items())
        return self._ask(text, '', f'<div class="choices">{buttons}</div>', lambda given: (
            given['choice'] if given.get('choice') in choices else None))

    def rate(self, text: str, scales: Mapping[str, Scale], keep: Callable[[str, float], None]) -> None:
        """See :class:`.asking.Asker`."""
        fields = ''.join(f"""
<fieldset class="scale"><legend id="{name}-is">{html.escape(scale.question)}</legend>
<input type="range" name="{name}" min="0" max="100" step="5" value="50" class="untouched"
  aria-labelledby="{name}-is">
<div class="anchors"><span>{html.escape(scale.low)}</span><span>{html.escape(scale.high)}</span></div>
</fieldset>""" for name, scale in scales.items())
        for name, value in self._ask(text, fields, _SEND, lambda given: _rated(given, scales)).items():
            keep(name, value)

    def answer(self, text: str, questions: Mapping[str, Question]) -> dict[str, str]:
        """See :class:`.asking.Asker`."""
        fields = ''.join(_field(_field_name(number), question) for number, question in enumerate(questions.values()))
        return self._ask(text, fields, _SEND, lambda given: _answered(given, questions))

    def tell(self, text: str) -> None:
        """See :class:`.asking.Asker`."""
        title, _, rest = text.partition('\n')
        page = _page('end', title, rest or 'You can close this window.')
        until = time.monotonic() + LAST_WORDS
        shown: list[bool] = []

        class Handler(_Handler):
            def do_GET(self) -> None:
                if self.is_allowed():
                    self.send(page, 'form')
                    if self.headers.get('Sec-Fetch-Mode', 'navigate') == 'navigate':
                        shown.append(True)

        with _Server((self._host, self._port), Handler) as server:
            while not shown and time.monotonic() < until:
                server.handle_request()

    def _ask(self, text: str, fields: str, buttons: str, read: Callable[[dict[str, str]], Any]) -> Any:
        """Serve a form until it is answered; what ``read`` makes of the answer, which is refused when that is None."""
        title, _, rest = text.strip().partition('\n')
        key = secrets.token_urlsafe(12)
        form = _page('form', title, rest, fields, buttons, key)
        wait = _page('wait', 'Thank you.', 'It goes on here in a moment …')
        answers: list[Any] = []

        class Handler(_Handler):
            def do_GET(self) -> None:
                if self.is_allowed():
                    self.answer()

            def do_POST(self) -> None:
                if not self.is_allowed():
                    return
                size = self.headers.get('Content-Length', '')
                given = {name: values[-1] for name, values in parse_qs(
                    self.rfile.read(min(int(size), SIZE_MAX) if size.isdecimal() else 0).decode(errors='replace'),
                    keep_blank_values=True).items()}
                answer = read(given) if given.get('key') == key else None
                if answer is not None and not answers:
                    answers.append(answer)
                self.answer()

            def answer(self) -> None:
                self.send(wait if answers else form, 'wait' if answers else 'form')

        with _Server((self._host, self._port), Handler) as server:
            while not answers:
                server.handle_request()
        return answers[0]


class _Handler(BaseHTTPRequestHandler):
    timeout = 2.0  # browsers open connections to have them, and say nothing

    def is_allowed(self) -> bool:
        """Whether it comes from this machine and from this page; otherwise it is refused."""
        host, origin = self.headers.get('Host', ''), self.headers.get('Origin')
        if is_loopback(host) and origin in (None, f'http://{host}'):
            return True
        self.send('this page is served to this machine only', 'refused', 403)
        return False

    def send(self, page: str, kind: str, code: int = 200) -> None:
        """Answer with a page, and say in the header of which kind it is."""
        body = page.encode()
        self.send_response(code)
        for name, value in (('Content-Type', 'text/html; charset=utf-8'), ('Cache-Control', 'no-store'),
                            ('Study-Page', kind), ('Content-Length', str(len(body))), *OWN_FRAMES_ONLY.items()):
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_: Any) -> None:
        """Nothing: the terminal is the experimenter's."""


class _Server(ThreadingHTTPServer):
    allow_reuse_address = True
    daemon_threads = False
    timeout = 0.5

    def __init__(self, address: tuple[str, int], handler: type[_Handler]):
        self.address_family = family_of(address[0])
        try:
            super().__init__(address, handler)
        except OSError as error:
            raise OSError(f'cannot serve the questions at {address[0]}:{address[1]} ({error.strerror}): end what is '
                          'there (the page of a session that is over stays for ten minutes: close it), or name another '
                          "--page in the plan's session_options") from error


def _page(kind: str, title: str, text: str, fields: str = '', buttons: str = '', key: str = '') -> str:
    return _PAGE.substitute(kind=kind, title=html.escape(title), text=html.escape(text.strip()), fields=fields,
                            buttons=buttons, key=key)


_SEND = '<div class="choices"><button>Go on</button></div>'


def _field_name(number: int) -> str:
    """The field of a question of the plan, by its place: plans may name a question like a field of the form."""
    return f'answer_{number}'


def _field(name: str, question: Question) -> str:
    ask = html.escape(question.ask)
    if not question.choices:
        return f'<label class="text">{ask}<textarea name="{name}" rows="3"></textarea></label>'
    choices = ''.join(f'<label><input type="radio" name="{name}" value="{html.escape(choice)}" required> '
                      f'{html.escape(choice)}</label>' for choice in question.choices)
    return f'<fieldset><legend>{ask}</legend>{choices}</fieldset>'


def _rated(given: dict[str, str], scales: Mapping[str, Scale]) -> dict[str, float] | None:
    try:
        values = {name: float(given[name]) for name in scales}
    except (KeyError, ValueError):
        return None
    return values if all(0.0 <= value <= 100.0 for value in values.values()) else None


def _answered(given: dict[str, str], questions: Mapping[str, Question]) -> dict[str, str] | None:
    answers = {}
    for number, (name, question) in enumerate(questions.items()):
        answer = given.get(_field_name(number), '')
        if question.choices and answer not in question.choices:
            return None
        answers[name] = answer if question.choices else answer.strip()
    return answers
