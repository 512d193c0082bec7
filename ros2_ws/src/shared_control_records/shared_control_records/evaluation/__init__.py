"""``shared-control evaluate``: tests of policies as tables and figures."""
