"""dentscope.recordings"""
