"""dentscope.impact"""
