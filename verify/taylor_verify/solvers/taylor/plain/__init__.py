"""heyoka as its manual calls it, with nothing of the driver's care: what each trap looks like.

The bodies of these functions are published as they stand; each is a few lines that anybody might
write, and each but the honest ones says that all went well.
"""
