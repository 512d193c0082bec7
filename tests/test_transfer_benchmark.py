"""Policies taught again on other arms: what is known is not computed again, and each tutor has figures of its own."""

import json

import pytest


@pytest.fixture
def transfer(load_benchmark, monkeypatch):
    """The script; teaching again takes each tutor as many episodes as its name has letters."""
    script = load_benchmark('transfer')
    monkeypatch.setattr(script, 'taught_again', lambda folder, change, tutor, seed: len(tutor))
    return script


@pytest.fixture
def policy(tmp_path):
    """The folder of a policy that fails with a heavy ball, and was taught again by the expert."""
    (tmp_path / '7' / 'transfer').mkdir(parents=True)
    (tmp_path / '7' / 'transfer' / 'ball_of_0.6_kg.json').write_text('{"success": 0.5, "error": 0.03, "again": 2}')
    return tmp_path / '7'


def test_each_tutor_has_figures_of_its_own(transfer, policy, capsys):
    def again(tutor, teaching=True):
        result = transfer.run(policy, 'ball of 0.6 kg', tutor, teaching)
        transfer.tell('heavy', [result], tutor)
        return capsys.readouterr().out.partition('skilled after ')[2][:9]

    assert again('expert') == '2 episode', 'that of a version which had one tutor'
    assert again('sham', teaching=False) == ''
    assert again('sham') == '4 episode'
    assert again('expert') == '2 episode'
    kept = json.loads((policy / 'transfer' / 'ball_of_0.6_kg.json').read_text())
    assert kept == {'success': 0.5, 'error': 0.03, 'again': 2, 'again by sham': 4}
