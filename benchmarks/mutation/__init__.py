"""Small faults put into the code: do the tests notice?"""
