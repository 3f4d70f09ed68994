"""dentscope.fem"""
