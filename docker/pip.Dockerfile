# No ROS install: rclpy and the messages come from pip like everything else.
#   docker build --file docker/pip.Dockerfile --tag shared-control:pip .
FROM python:3.11-slim
WORKDIR /shared-control
COPY requirements.txt ./
COPY tools/slim_environment.py tools/
RUN pip install --no-cache-dir --requirement requirements.txt \
 && python tools/slim_environment.py
COPY . ./
RUN pip install --no-cache-dir --no-deps --no-build-isolation . \
 && useradd --create-home --uid 1000 trainer \
 && chown --recursive 1000 /shared-control

# Shared memory between containers needs one user; files in out/ then belong to the host's first user, too.
USER 1000
ENV OMP_NUM_THREADS=1 \
    PYTHONUNBUFFERED=1
CMD ["shared-control", "--help"]
