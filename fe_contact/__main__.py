"""``python -m fe_contact``."""

import sys

from fe_contact.cli import main

sys.exit(main())
