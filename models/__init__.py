"""dentscope.models"""
