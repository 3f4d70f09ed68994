"""dentscope.fitting"""
