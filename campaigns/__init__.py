"""Stage campaigns: hundreds of finite-element cases into one HDF5 file."""
