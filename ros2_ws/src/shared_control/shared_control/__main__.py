"""``python -m shared_control``."""

from .cli import main

raise SystemExit(main())
