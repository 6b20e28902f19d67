import sys

sys.dont_write_bytecode = True  # the source tree stays as it is, whoever starts pytest
