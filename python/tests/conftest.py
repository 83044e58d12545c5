"""What all tests need of the process that they run in."""

import signal

# A shell that starts the tests in the background has them ignore the interrupts that some of them send themselves, and
# these would then wait for ever. Python's own handler holds in the processes that tests start, too.
signal.signal(signal.SIGINT, signal.default_int_handler)
