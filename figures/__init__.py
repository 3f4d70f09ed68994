"""dentscope.figures"""
