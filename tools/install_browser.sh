#!/usr/bin/env bash
# Chromium and its driver, for the tests of the page; nothing is done when they are there. Needs root (Debian, Ubuntu).
set -euo pipefail
command -v chromedriver > /dev/null && command -v chromium chromium-browser google-chrome > /dev/null && exit 0
apt-get update -qq
apt-get install -y -qq --no-install-recommends chromium chromium-driver
