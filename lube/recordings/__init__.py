"""Reading measured voltage and resistance recordings: CSV, NetCDF and TDMS files, and manifests."""
