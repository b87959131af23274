"""What a key accepts, written once; TOML, CSV and JSON; members found by name; where the packaged data lie."""
