"""Makes `small_worlds`, `action_home` and `walks` importable for the tests here."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
if str(HERE) not in sys.path:
    sys.path.insert(0, str(HERE))
