"""The page to work in: served on the loopback address, landmarks placed by hand, the pair matched again with them"""
