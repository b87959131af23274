"""A ball struck by a ball."""

from __future__ import annotations

from fe_contact.validation.waves.half_space import of as of
