# For ports that are built with make: `make USER_C_MODULES=FOLDER`, where FOLDER is the one that has this folder inside.
PANTIN_MODULE := $(USERMOD_DIR)

SRC_USERMOD_C += $(addprefix $(PANTIN_MODULE)/, mod_pantin.c mod_figure.c mod_face.c)
SRC_USERMOD_LIB_C += $(addprefix $(PANTIN_MODULE)/src/, \
	pantin.c pantin_keys.c pantin_turn.c pantin_figure.c pantin_solid.c pantin_face.c pantin_talk.c)
CFLAGS_USERMOD += -I$(PANTIN_MODULE)/src -DPANTIN_KEYS
