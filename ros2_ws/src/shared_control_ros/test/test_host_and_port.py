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

"""Addresses on command lines."""

import argparse

import pytest
from shared_control_ros.host_and_port import host_and_port


@pytest.mark.parametrize(('text', 'address'), [
    ('127.0.0.1:8089', ('127.0.0.1', 8089)), ('laptop:0', ('laptop', 0)), ('[::1]:65535', ('::1', 65535))])
def test_an_address_is_host_and_port(text, address):
    assert host_and_port(text) == address


@pytest.mark.parametrize('text', ['', '8089', ':8089', 'laptop', 'laptop:', 'laptop:-1', 'laptop:x', 'laptop:65536',
                                  '127.0.0.1:99999'])
def test_what_is_no_address_is_refused_as_an_option(text, capsys):
    parser = argparse.ArgumentParser()
    parser.add_argument('--page', type=host_and_port)
    with pytest.raises(SystemExit) as end:
        parser.parse_args(['--page', text])
    assert end.value.code == 2
    assert f'{text!r}' in capsys.readouterr().err
