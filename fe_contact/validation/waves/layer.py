"""The layer on its rigid base."""

from __future__ import annotations

from fe_contact.validation.waves.half_space import of as of
