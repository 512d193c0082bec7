from setuptools import find_packages, setup

package_name = 'shared_control_learning'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    package_data={package_name: ['py.typed']},
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=[
        'shared_control', 'shared_control_sim', 'numpy', 'gymnasium', 'torch', 'stable-baselines3', 'safetensors',
        'pydantic', 'scipy', 'tqdm',
    ],
    extras_require={'test': ['pytest'], 'tensorboard': ['tensorboard']},
    zip_safe=False,
    maintainer='shared-control maintainers',
    maintainer_email='maintainers@shared-control.invalid',
    description='Learning from people and rewards: PPO, corrections, policy files, training, tests of a policy.',
    license='Apache-2.0',
    entry_points={
        'shared_control.commands': [
            'train = shared_control_learning.commands:add_train',
            'tutors = shared_control_learning.commands:add_tutors',
        ],
        'shared_control.learners': [
            'guided = shared_control_learning.presets:GUIDED',
            'coached = shared_control_learning.presets:COACHED',
            'coached_network = shared_control_learning.presets:COACHED_NETWORK',
            'thesis = shared_control_learning.presets:THESIS_PPO',
            'autonomous = shared_control_learning.presets:AUTONOMOUS',
            'pd = shared_control_learning.baselines.presets:PD',
            'lqr = shared_control_learning.baselines.presets:LQR',
            'identified_lqr = shared_control_learning.baselines.presets:IDENTIFIED_LQR',
            'behaviour_cloning = shared_control_learning.baselines.presets:BEHAVIOUR_CLONING',
            'hg_dagger = shared_control_learning.baselines.presets:HG_DAGGER',
            'dcoach = shared_control_learning.baselines.presets:DCOACH',
            'sac_interventions = shared_control_learning.baselines.presets:SAC_INTERVENTIONS',
            'pvp = shared_control_learning.baselines.presets:PVP',
        ],
    },
)
