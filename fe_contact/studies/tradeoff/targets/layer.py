"""The layer on its rigid base."""

from __future__ import annotations

from fe_contact.studies.tradeoff.targets.half_space import of as of
