"""What a key accepts, written once; TOML, CSV and JSON; members found by name; where the packaged data lie."""

from typing import Any

Table = dict[str, Any]  # as TOML and JSON have it, read or to be written: what a key holds, its reader has to know
