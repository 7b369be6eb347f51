"""What the Snakefile and its scripts need."""
