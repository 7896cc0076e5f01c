"""Landmarks of one template on a whole collection: carried, in tables and pictures, with a list of what needs a look"""
