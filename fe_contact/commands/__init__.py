"""The commands of ``fe-contact``, one a file; what several of them share is in ``base.py``."""

from fe_contact.commands.base import Command
from lumped.schema.members import Folder

COMMANDS = Folder[Command](__name__)
