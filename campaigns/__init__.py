"""dentscope.campaigns"""
