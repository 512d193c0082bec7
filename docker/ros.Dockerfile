# ROS 2 Jazzy from Debian packages, everything else from pip, the workspace built by colcon.
#   docker build --file docker/ros.Dockerfile --tag shared-control:ros .
FROM ros:jazzy-ros-base
SHELL ["/bin/bash", "-o", "pipefail", "-c"]

# Versions are those of the base image's snapshot of Jazzy. The compiler is for PyBullet, which has no wheel for Python 3.12.
# hadolint ignore=DL3008
RUN apt-get update \
 && apt-get install --yes --no-install-recommends \
      g++ make python3-dev python3-venv \
      ros-jazzy-foxglove-bridge ros-jazzy-robot-state-publisher ros-jazzy-rosbag2-storage-mcap \
 && rm -rf /var/lib/apt/lists/*

WORKDIR /shared-control
COPY requirements.txt ./
COPY tools/slim_environment.py tools/
# Everything that is pinned but ROS itself, which the image has.
RUN python3 -m venv --system-site-packages /opt/venv \
 && grep --invert-match '^ros-' requirements.txt > /tmp/requirements.txt \
 && /opt/venv/bin/pip install --no-cache-dir --requirement /tmp/requirements.txt \
 && /opt/venv/bin/python tools/slim_environment.py \
 && rm /tmp/requirements.txt

COPY . ./
WORKDIR /shared-control/ros2_ws
RUN source /opt/ros/jazzy/setup.bash \
 && /opt/venv/bin/python -m colcon build --merge-install --base-paths src \
 && chown --recursive 1000 /shared-control
WORKDIR /shared-control

# Shared memory between containers needs one user; files in out/ then belong to the host's first user, too.
USER 1000
ENV OMP_NUM_THREADS=1 \
    PYTHONUNBUFFERED=1
ENTRYPOINT ["/shared-control/docker/ros_entrypoint.sh"]
CMD ["bash"]
