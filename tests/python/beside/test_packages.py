# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""By itself the package imports no other package than NumPy."""

import subprocess
import sys


def test_import_loads_numpy_alone():
    others = ["IPython", "distributed", "matplotlib", "pandas", "pybullet", "trimesh"]
    code = f"import sys, tetskin; print([name for name in {others} if name in sys.modules])"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"
