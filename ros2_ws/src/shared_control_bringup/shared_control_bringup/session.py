"""``shared-control session``: teach the robot, keep everything, measure what it has learned."""

import argparse
import json
import signal
import sys
import time
from enum import Enum
from pathlib import Path
from typing import Any

from session_recorder_node import annotate, recover
from shared_control.plugins import LEARNERS, names
from shared_control.teaching.profiles import PROFILES
from shared_control_learning.presets import preset
from shared_control_records.session import bag_metadata as in_bag
from shared_control_records.session.folder import SessionFolder
from shared_control_ros.host_and_port import host_and_port

from . import parameters as ros_parameters
from .node_process import NodeProcess
from .progress import AddressPrinter, EpisodePrinter
from .supervisor import SessionError, StoppedByNode, Supervisor

POLL_SECONDS = 0.1


def add_command(commands: argparse._SubParsersAction) -> None:
    """Add ``session`` to the ``shared-control`` command."""
    parser = commands.add_parser(
        'session', help='teach the robot on the running graph', description=__doc__,
        formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument('--tutor', choices=('keyboard', 'page', 'sim', 'none'), default='keyboard',
                        help='who teaches: you at this terminal, you in a browser, a simulated tutor, or nobody')
    parser.add_argument('--page', type=host_and_port, default='127.0.0.1:8088', metavar='HOST:PORT',
                        help='where the page of --tutor page is served; another host than loopback opens it to the '
                        'network, with a token')
    parser.add_argument('--profile', choices=tuple(PROFILES), default='expert', help='of the simulated tutor')
    parser.add_argument('--preset', choices=names(LEARNERS), default='coached', help='what is learned and how')
    parser.add_argument('--episodes', type=int, default=0,
                        help='teach this many, then test; 0: until you say that it has learned it')
    parser.add_argument('--minutes', type=float, default=45.0, help='teach for this long at the most')
    parser.add_argument('--test-episodes', type=int, default=20, help='of the policy alone, at the end')
    parser.add_argument('--seed', type=int, default=0, help='of ball starts, learner and simulated tutor')
    parser.add_argument('--output', type=Path, default=None,
                        help='folder of the session; a new one below out/sessions when not given')
    parser.add_argument('--overwrite', action='store_true', help='remove what an earlier session left in that folder')
    parser.add_argument('--resume', type=Path, default=None, metavar='FOLDER',
                        help='go on with an earlier session: its learner, its settings, its folder')
    parser.add_argument('--params-file', type=Path, default=ros_parameters.DEFAULTS, help='ROS parameters of the nodes')
    parser.add_argument('--no-screen', action='store_true', help='print a line an episode instead of the screen')
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Run a session and report it; the exit code."""
    folder, settings = _resumed(args.resume) if args.resume else _new(args)
    if settings['tutor'] == 'keyboard' and not _has_terminal():
        raise ValueError('there is no terminal to press keys in: use --tutor sim, or start the session from one')
    shows_screen = _has_terminal() and not args.no_screen and settings['tutor'] != 'page'
    parameters = _parameters(settings, folder, shows_screen)
    ros_parameters.save(parameters, folder.parameters)
    folder.settings.write_text(json.dumps(settings, indent=2) + '\n')

    print(f'Session in {folder.path}: {settings["preset"]}, tutor: {settings["tutor"]}.', flush=True)
    end, restarts = _teach(settings, folder, shows_screen)
    # Imported late: torch and matplotlib take seconds, and the person wants to begin.
    from shared_control_records.session.report import write_report

    from .aftermath import describe_policy, tell_summary, test_policy
    if folder.bag.exists():
        recover(folder.bag)
    if end is not End.FAILED:
        describe_policy(folder)
    if end is End.DONE and settings['test_episodes']:
        test_policy(folder, settings['test_episodes'])
    if folder.bag.exists() and any(folder.bag.glob('*.mcap')):
        annotate(folder.bag, in_bag.RECORD, in_bag.pack(folder, restarts))
    tell_summary(folder, write_report(folder, restarts))
    if end is not End.DONE:
        print(f'Stopped before the end. Go on with\n  shared-control session --resume {folder.path}')
    return end.value


class End(Enum):
    """How the teaching ended; the value is the exit code."""

    DONE = 0
    FAILED = 1
    STOPPED = 130


def _new(args: argparse.Namespace) -> tuple[SessionFolder, dict[str, Any]]:
    """Folder and settings of a new session."""
    path = args.output or Path('out/sessions') / time.strftime('%Y-%m-%d_%H-%M-%S')
    settings = {
        'preset': args.preset, 'tutor': f'simulated: {args.profile}' if args.tutor == 'sim' else args.tutor,
        'episodes': args.episodes, 'minutes': args.minutes, 'test_episodes': args.test_episodes, 'seed': args.seed,
        'page': list(args.page), 'params_file': str(args.params_file)}
    return SessionFolder.create(path, overwrite=args.overwrite), settings


def _resumed(path: Path) -> tuple[SessionFolder, dict[str, Any]]:
    """Folder and settings of an earlier session."""
    folder = SessionFolder.open(path)
    folder.claim()
    return folder, json.loads(folder.settings.read_text())


def _parameters(settings: dict[str, Any], folder: SessionFolder, shows_screen: bool) -> dict[str, dict[str, Any]]:
    """ROS parameters of all nodes."""
    parameters = ros_parameters.load(Path(settings['params_file']))

    def put(node: str, **values: Any) -> None:
        parameters.setdefault(node, {}).update(values)

    put('panda_sim_node', seed=settings['seed'])
    put('torque_ctrl_node', moment_limit=float(preset(settings['preset']).task.limit.max()))
    put('teleop_key_node', screen='auto' if shows_screen else 'off')
    put('ppo_agent_node', preset=settings['preset'], seed=settings['seed'], episodes=settings['episodes'],
        max_minutes=settings['minutes'], practice=settings['tutor'] == 'page', output=str(folder.learner))
    put('session_recorder_node', output=str(folder.bag))
    if settings['tutor'] == 'page':
        host, port = settings['page']
        put('teach_page_node', host=host, port=port)
    if settings['tutor'].startswith('simulated'):
        put('sim_tutor_node', profile=settings['tutor'].removeprefix('simulated: '), seed=settings['seed'])
    return parameters


def _teach(settings: dict[str, Any], folder: SessionFolder, shows_screen: bool) -> tuple[End, int]:
    """Run the graph until the agent is done or somebody stops it: how it ended, and restarts of nodes."""
    nodes_needed = ['session_recorder_node', 'torque_ctrl_node', 'panda_sim_node', 'teleop_key_node']
    if settings['tutor'].startswith('simulated'):
        nodes_needed.append('sim_tutor_node')
    if settings['tutor'] == 'page':
        nodes_needed.append('teach_page_node')
    nodes_needed.append('ppo_agent_node')
    paced = ros_parameters.load(folder.parameters).get('panda_sim_node', {}).get('paced', True)
    nodes = [NodeProcess(name, folder.parameters, folder.logs / f'{name}.log', in_real_time=paced,
                         in_foreground=shows_screen and name == 'teleop_key_node') for name in nodes_needed]
    log = (folder.logs / 'session.log').open('a')

    def say(text: str) -> None:
        print(time.strftime('%H:%M:%S'), text, file=log, flush=True)
        if not shows_screen:
            print(text, flush=True)

    supervisor = Supervisor(nodes, leader='ppo_agent_node', stopper='teach_page_node', say=say)
    episodes = EpisodePrinter(folder.episodes, say)
    page = AddressPrinter(folder.logs / 'teach_page_node.log', say)
    previous = {number: signal.signal(number, _interrupt) for number in (signal.SIGTERM, signal.SIGHUP)}
    error: SessionError | None = None
    try:
        supervisor.start()
        while supervisor.poll():
            episodes.poll()
            page.poll()
            time.sleep(POLL_SECONDS)
        end = End.DONE
    except (KeyboardInterrupt, StoppedByNode):
        end = End.STOPPED
    except SessionError as problem:
        end, error = End.FAILED, problem
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        supervisor.stop()
        episodes.poll()
        signal.signal(signal.SIGINT, signal.default_int_handler)
        for number, handler in previous.items():
            signal.signal(number, handler)
        log.close()
    if error is not None:
        print(f'shared-control: {error}', file=sys.stderr)
    return end, supervisor.restarts


def _interrupt(*_: object) -> None:
    raise KeyboardInterrupt


def _has_terminal() -> bool:
    try:
        Path('/dev/tty').open('rb').close()
    except OSError:
        return False
    return sys.stdin.isatty()
