"""The stages of the study: datasets in, datasets out. None imports another."""
