"""The table of episodes, taken up again."""

import pytest
from shared_control_learning.episode_table import EpisodeTable

TABLE = """episode,phase,seconds,learn_seconds
1,teach,15.0,0.5
2,teach,3.0,0.25
3,teach,15.0,0.5
1,test,10.0,0.0
"""


def test_the_time_of_teaching_goes_on_where_it_was(tmp_path):
    path = tmp_path / 'episodes.csv'
    assert EpisodeTable(path).taught_seconds == 0.0
    path.write_text(TABLE)
    # The third row is of an episode that was not learned from before the run was killed; a test is no teaching.
    assert EpisodeTable(path, taught=2).taught_seconds == pytest.approx(18.75)
