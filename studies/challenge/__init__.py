"""The challenge: made-up recordings for whoever has a method of his own, and what scores it.

archive    the sets as they are shipped, data/blind-sets, and their seals
answers    probabilities by set and name, as a stranger's method writes them
score      answers beside truths
draw       makes the archive: sets of the proof's generators from secret seeds of their own
ask        sets that answer: trials are bought of them
own        what the diagnosis and a simple rule answer
"""
