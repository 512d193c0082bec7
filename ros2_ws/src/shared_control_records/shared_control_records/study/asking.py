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

"""How a participant is asked: at the terminal, or on a page (:mod:`.form_page`)."""

import shutil
import textwrap
from collections.abc import Callable, Mapping
from typing import Protocol

from .plan_file import Question
from .progress import Scale

STEP = 'back'
"""What is typed to answer the question before once more."""


class Asker(Protocol):
    """Asks; every method returns when there is an answer.

    Raises:
        EOFError: nobody answers any more.
    """

    def consent(self, text: str) -> bool:
        """Whether they agree."""

    def ready(self, text: str) -> None:
        """Until they want to go on."""

    def choose(self, text: str, choices: Mapping[str, str]) -> str:
        """One of the keys of ``choices``, whose values say what they mean."""

    def rate(self, text: str, scales: Mapping[str, Scale], keep: Callable[[str, float], None]) -> None:
        """A number from 0 to 100 on each scale; ``keep`` takes each as soon as it is given."""

    def answer(self, text: str, questions: Mapping[str, Question]) -> dict[str, str]:
        """An answer to each question."""

    def tell(self, text: str) -> None:
        """Say something, without an answer."""


def _show(text: str) -> None:
    """Print a text, its lines wrapped between words."""
    width = shutil.get_terminal_size().columns - 1
    print('\n'.join(part for line in text.split('\n') for part in textwrap.wrap(line, width) or ['']))


class TerminalAsker:
    """At this terminal."""

    def consent(self, text: str) -> bool:
        """See :class:`Asker`."""
        _show(text)
        return input('\nDo you agree? Type yes or no: ').strip().lower() == 'yes'

    def ready(self, text: str) -> None:
        """See :class:`Asker`."""
        _show(f'\n{text}')
        input('Press Enter to go on. ')

    def choose(self, text: str, choices: Mapping[str, str]) -> str:
        """See :class:`Asker`."""
        keys = list(choices)
        _show(f'\n{text}')
        for number, key in enumerate(keys, start=1):
            print(f'  {number}: {choices[key]}')
        while True:
            given = input(f'Your choice, 1 to {len(keys)}: ').strip()
            if given.isdecimal() and 1 <= int(given) <= len(keys):
                return keys[int(given) - 1]

    def rate(self, text: str, scales: Mapping[str, Scale], keep: Callable[[str, float], None]) -> None:
        """See :class:`Asker`."""
        _show(f'\n{text} Answer each with a number from 0 to 100; "{STEP}" returns to the question before.')
        names, at = list(scales), 0
        while at < len(names):
            scale = scales[names[at]]
            _show(f'\n{scale.question}')
            given = input(f'  0 ({scale.low}) to 100 ({scale.high}): ').strip().lower()
            if given == STEP:
                at = max(at - 1, 0)
                continue
            try:
                value = float(given)
            except ValueError:
                value = -1.0
            if 0.0 <= value <= 100.0:
                keep(names[at], value)
                at += 1
            else:
                print('  A number from 0 to 100, please.')

    def answer(self, text: str, questions: Mapping[str, Question]) -> dict[str, str]:
        """See :class:`Asker`."""
        _show(f'\n{text}')
        return {name: self.choose(question.ask, dict(zip(question.choices, question.choices, strict=True)))
                if question.choices else self._text(question.ask) for name, question in questions.items()}

    @staticmethod
    def _text(ask: str) -> str:
        _show(f'\n{ask}')
        return input('> ').strip()

    def tell(self, text: str) -> None:
        """See :class:`Asker`."""
        _show(text)
