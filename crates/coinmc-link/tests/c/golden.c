/* Checks coinmc_link.h against the golden frames: usage `golden FILE`. */
#include "coinmc_link.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

static const char *line_text;

static int fail(const char *why)
{
    printf("%s: %s\n", why, line_text);
    return 1;
}

/* The number after " key=". */
static long long number(const char *key)
{
    char pattern[32];
    snprintf(pattern, sizeof pattern, " %s=", key);
    const char *found = strstr(line_text, pattern);
    if (found == NULL) {
        printf("no %s in: %s\n", key, line_text);
        exit(1);
    }
    return strtoll(found + strlen(pattern), NULL, 10);
}

static void request_text(char *text, size_t size, const coinmc_received *frame,
                         const coinmc_request *r)
{
    static const char *const names[] = {"hello", "info",          "status", "stop",    "home",
                                        "throw", "move_carriage", "light",  "collect", "clear_fault",
                                        "set_counter"};
    int at = snprintf(text, size, "request %s session=%u seq=%u", names[r->kind],
                      (unsigned)frame->session, (unsigned)frame->seq);
    text += at;
    size -= (size_t)at;
    switch (r->kind) {
    case COINMC_REQUEST_HELLO:
        snprintf(text, size, " major=%u minor=%u", r->major, r->minor);
        break;
    case COINMC_REQUEST_HOME:
        snprintf(text, size, " axes=%u", r->axes);
        break;
    case COINMC_REQUEST_THROW:
        snprintf(text, size,
                 " throw_id=%" PRIu32 " experiment=%" PRIu32 " spin_mrev_s=%u angle_cdeg=%u",
                 r->throw_id, r->experiment, r->spin_mrev_s, r->angle_cdeg);
        break;
    case COINMC_REQUEST_MOVE_CARRIAGE:
        snprintf(text, size, " x_um=%" PRId32 " y_um=%" PRId32, r->x_um, r->y_um);
        break;
    case COINMC_REQUEST_LIGHT:
        snprintf(text, size, " permille=%u", r->permille);
        break;
    case COINMC_REQUEST_COLLECT:
        snprintf(text, size, " throw_id=%" PRIu32, r->throw_id);
        break;
    case COINMC_REQUEST_SET_COUNTER:
        snprintf(text, size, " throw_id=%" PRIu32 " experiment=%" PRIu32, r->throw_id,
                 r->experiment);
        break;
    case COINMC_REQUEST_CLEAR_FAULT:
        snprintf(text, size, " code=%u", r->code);
        break;
    default:
        break;
    }
}

static void parse_info(coinmc_info *info)
{
    const char *uid = strstr(line_text, " uid="), *firmware = strstr(line_text, " firmware=");
    unsigned part[8] = {0};
    sscanf(uid, " uid=%2x%2x%2x%2x%2x%2x%2x%2x", &part[0], &part[1], &part[2], &part[3], &part[4],
           &part[5], &part[6], &part[7]);
    for (int i = 0; i < 8; i++)
        info->uid[i] = (uint8_t)part[i];
    sscanf(firmware, " firmware=%u.%u.%u", &part[0], &part[1], &part[2]);
    for (int i = 0; i < 3; i++)
        info->firmware[i] = (uint8_t)part[i];
    info->capabilities = (uint32_t)number("capabilities");
    info->spin_mrev_s = (uint16_t)number("spin_mrev_s");
    info->angle_cdeg = (uint16_t)number("angle_cdeg");
    info->x_um = (int32_t)number("x_um");
    info->y_um = (int32_t)number("y_um");
}

static void parse_status(coinmc_status *status)
{
    status->state = (uint8_t)number("state");
    status->throw_id = (uint32_t)number("throw_id");
    status->experiment = (uint32_t)number("experiment");
    status->spin_mrev_s = (uint16_t)number("spin_mrev_s");
    status->angle_cdeg = (uint16_t)number("angle_cdeg");
    status->released = number("released") != 0;
    status->meas_spin_mrev_s = (uint16_t)number("meas_spin_mrev_s");
    status->meas_angle_cdeg = (uint16_t)number("meas_angle_cdeg");
    status->x_um = (int32_t)number("x_um");
    status->y_um = (int32_t)number("y_um");
    status->t_ms = (uint32_t)number("t_ms");
    status->t_release_ms = (uint32_t)number("t_release_ms");
    status->fault = (uint16_t)number("fault");
    status->rx_bad = (uint16_t)number("rx_bad");
}

static void parse_reply(coinmc_reply *reply)
{
    const char *name = line_text + strlen("reply ");
    if (strncmp(name, "hello ", 6) == 0) {
        reply->kind = COINMC_REPLY_HELLO;
        reply->as.hello.major = (uint8_t)number("major");
        reply->as.hello.minor = (uint8_t)number("minor");
        reply->as.hello.boot = (uint16_t)number("boot");
        reply->as.hello.throw_id = (uint32_t)number("throw_id");
        reply->as.hello.state = (uint8_t)number("state");
    } else if (strncmp(name, "info ", 5) == 0) {
        reply->kind = COINMC_REPLY_INFO;
        parse_info(&reply->as.info);
    } else if (strncmp(name, "ok ", 3) == 0) {
        reply->kind = COINMC_REPLY_OK;
        reply->as.ok.throw_id = (uint32_t)number("throw_id");
        reply->as.ok.state = (uint8_t)number("state");
    } else if (strncmp(name, "nak ", 4) == 0) {
        reply->kind = COINMC_REPLY_NAK;
        reply->as.nak = (uint8_t)number("reason");
    } else {
        reply->kind = COINMC_REPLY_STATUS;
        parse_status(&reply->as.status);
    }
}

static int check_request(const coinmc_received *frame, coinmc_read expected)
{
    coinmc_request request;
    char text[200];
    if (coinmc_read_request(frame->body, frame->length, &request) != expected)
        return fail("read differently");
    if (expected != COINMC_GOOD)
        return 0;
    request_text(text, sizeof text, frame, &request);
    return strcmp(text, line_text) == 0 ? 0 : fail(text);
}

static int check_reply(const uint8_t *bytes, size_t length)
{
    coinmc_reply reply;
    uint8_t body[COINMC_MAX_BODY], wire[COINMC_MAX_WIRE];
    parse_reply(&reply);
    uint8_t written = coinmc_frame((uint16_t)number("session"), (uint16_t)number("seq"), body,
                                   coinmc_write_reply(&reply, body), wire);
    return written == length && memcmp(wire, bytes, length) == 0 ? 0 : fail("written differently");
}

static int check(char *line)
{
    line_text = line;
    char *colon = strstr(line, " : ");
    uint8_t bytes[100];
    size_t length = 0;
    if (colon == NULL)
        return fail("no colon");
    *colon = 0;
    for (char *hex = colon + 2, *end; length < sizeof bytes; hex = end) {
        unsigned long byte = strtoul(hex, &end, 16);
        if (end == hex)
            break;
        bytes[length++] = (uint8_t)byte;
    }
    coinmc_decoder decoder = {0};
    coinmc_received frame = {0};
    bool whole = false;
    for (size_t i = 0; i < length; i++)
        whole |= coinmc_push(&decoder, bytes[i], &frame) == COINMC_FRAME;
    if (strncmp(line, "reject ", 7) == 0)
        return whole ? fail("not rejected") : 0;
    if (!whole)
        return fail("rejected");
    if (strncmp(line, "malformed ", 10) == 0)
        return check_request(&frame, COINMC_MALFORMED);
    if (strncmp(line, "out_of_range ", 13) == 0)
        return check_request(&frame, COINMC_OUT_OF_RANGE);
    if (strncmp(line, "request ", 8) == 0)
        return check_request(&frame, COINMC_GOOD);
    return check_reply(bytes, length);
}

int main(int count, char **arguments)
{
    FILE *file = count == 2 ? fopen(arguments[1], "r") : NULL;
    char line[600];
    int checked = 0, failed = 0;
    if (file == NULL)
        return 2;
    while (fgets(line, sizeof line, file) != NULL) {
        if (line[0] == '#' || line[0] == '\n')
            continue;
        failed += check(line);
        checked++;
    }
    fclose(file);
    printf("%d frames checked, %d failed\n", checked, failed);
    return failed != 0;
}
